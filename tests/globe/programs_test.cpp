// A scene pays for none of what it does not use: which shader programs there are, by name.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

#include <epoxy/gl.h>

namespace terrella::test {
namespace {

using Names = std::set<std::string>;
constexpr Viewport kProgramsPicture{64, 64};
const TileGrid kProgramsGrid{.tile_px = 64, .max_level = 1};

/// Labels of all programs in the context; a label is the file that distinguishes the program.
std::multiset<std::string> all_programs() {
  constexpr GLuint kMostNames = 4096;  // objects of a context are numbered from 1
  std::multiset<std::string> names;
  for (GLuint name = 1; name < kMostNames; ++name) {
    if (glIsProgram(name) == GL_FALSE) continue;
    char label[256] = {};
    glGetObjectLabel(GL_PROGRAM, name, sizeof label, nullptr, label);
    names.insert(label);
  }
  return names;
}
Names programs() {
  const auto all = all_programs();
  return {all.begin(), all.end()};
}

class Programs : public GlTest {
 protected:
  /// Those that a globe's frame has made.
  Names of(const GlobeOptions& options, const ObjectScene& objects = {}) {
    const auto globe = make_globe(options, one_colour(kProgramsGrid, {200, 120, 40}));
    if (!objects.empty()) {
      EXPECT_TRUE(globe->add_objects(objects));
    }
    globe->set_camera(camera_at(10, 20, 2.0e7));
    settle(*globe, kProgramsPicture);
    return programs();
  }
  /// Names that the plain globe does not have.
  static Names more(Names all) {
    for (const std::string& name : plain()) EXPECT_EQ(all.erase(name), 1U) << name;
    return all;
  }
  static Names plain() {
    return {"limb_whole.frag", "patch_limb.frag", "patch_oblique.frag", "patch_plain.frag", "patch_polar_long.frag"};
  }
};

TEST_F(Programs, ThePlainGlobeHasThoseOfItsGroundAndItsLimb) {
  EXPECT_EQ(of({}), plain());
  GlobeOptions options;
  options.texturing = Texturing::exact;
  EXPECT_EQ(of(options), (Names{"limb_whole.frag", "patch_limb.frag", "patch_polar_long.frag"}));
}

TEST_F(Programs, APatchProgramComesWithTheFirstPatchThatNeedsIt) {
  const auto globe = make_globe({}, one_colour(kProgramsGrid, {200, 120, 40}));
  const auto at = [&](double lat_deg, double height_m) {
    globe->set_camera(camera_at(lat_deg, 20, height_m));
    settle(*globe, kProgramsPicture);
    return programs();
  };
  Names expected{"limb_whole.frag", "patch_magnified.frag", "patch_plain.frag"};
  EXPECT_EQ(at(10, 1.0e5), expected) << "neither a pole is in view, nor the limb";
  expected.insert("patch_polar_short.frag");
  EXPECT_EQ(at(90, 1.0e3), expected) << "magnified: three taps, and no loop";
  expected.insert("patch_polar_long.frag");
  EXPECT_EQ(at(90, 1.0e5), expected) << "seven taps for long pixels, written out";
  expected.insert({"patch_oblique.frag", "patch_limb.frag"});
  EXPECT_EQ(at(10, 2.0e7), expected);
}

TEST_F(Programs, TranslucencyBringsADepthPassAndWithSomethingBelowTheInnerSphere) {
  GlobeOptions options;
  options.surface.alpha = 0.5;
  EXPECT_EQ(more(of(options)), Names{"patch_depth.frag"});
  const ObjectScene below{.points = {{.place = {.lat = {}, .lon = {}, .height_m = -2.0e5}}}};
  const Names all = more(of(options, below));
  EXPECT_TRUE(all.contains("patch_depth.frag") && all.contains("inner_sphere.frag")) << testing::PrintToString(all);
}

TEST_F(Programs, StereoBringsOneWhereRowsAreToldApartAndNoneElse) {
  GlobeOptions options;
  for (const Stereo stereo : {Stereo::side_by_side, Stereo::anaglyph}) {
    options.stereo.mode = stereo;
    EXPECT_EQ(of(options), plain());
  }
  options.stereo.mode = Stereo::interlaced;
  EXPECT_EQ(more(of(options)), Names{"interlace.frag"});
}

// A pass over a patch combines its layers: each number of layers, of each kind, has programs of its own.
TEST_F(Programs, EachFurtherLayerBringsThemOnceMore) {
  const auto globe = make_globe({}, one_colour(kProgramsGrid, {200, 120, 40}));
  globe->set_camera(camera_at(10, 20, 2.0e7));
  const auto count = [&](const ImageLook& look) {
    EXPECT_TRUE(globe->add_imagery(one_colour(kProgramsGrid, {200, 120, 40}), look));
    settle(*globe, kProgramsPicture);
    const auto all = all_programs();
    return std::pair(all.count("patch_plain.frag"), all.size());
  };
  settle(*globe, kProgramsPicture);
  const std::size_t alone = all_programs().size(), of_patches = alone - 1;
  const std::pair twice{std::size_t{2}, alone + of_patches + 2};
  EXPECT_EQ(count({.opacity = 0.5}), twice) << "and a flat one, of whole patches and of the limb";
  EXPECT_EQ(count({.opacity = 0.5, .daylight = Daylight::day}), std::pair(std::size_t{3}, twice.second + of_patches));
  EXPECT_EQ(count({.alpha = AlphaFrom::brightness}), std::pair(std::size_t{4}, twice.second + 2 * of_patches));
}

TEST_F(Programs, NumbersBringThoseOfTheirLayersPart) {
  const auto globe = make_globe({}, one_colour(kProgramsGrid, {200, 120, 40}));
  globe->set_camera(camera_at(10, 20, 2.0e7));
  settle(*globe, kProgramsPicture);
  const std::size_t alone = all_programs().size();
  const auto numbers =
      std::make_shared<PaintedNumbers>(kProgramsGrid, [](double lon, double) { return static_cast<float>(lon); });
  ImageLook look{.opacity = 0.5};
  look.numbers = NumberLook{};
  const auto layer = globe->add_imagery(numbers, look);
  ASSERT_TRUE(layer);
  settle(*globe, kProgramsPicture);
  const std::size_t of_patches = alone - 1;
  EXPECT_EQ(all_programs().size(), alone + of_patches + 2) << "and a flat one, of whole patches and of the limb";
  look.opacity = 1.0;
  ASSERT_TRUE(globe->set_look(*layer, look) && globe->move(*layer, 0));
  settle(*globe, kProgramsPicture);
  EXPECT_EQ(all_programs().size(), alone + 2 * of_patches + 2) << "as the base layer under the picture";
}

// Numbers are filtered in one way, and the air before glass is the same in every light.
TEST_F(Programs, AnotherFilterMakesOnlyThoseThatDependOnIt) {
  GlobeOptions options;
  options.sky = true;
  options.surface = {.alpha = 0.5, .sharpness = Sharpness::bilinear};
  const auto globe = make_globe(options, one_colour(kProgramsGrid, {200, 120, 40}));
  globe->set_camera(camera_at(10, 20, 2.0e7));
  ImageLook look{.opacity = 0.5};
  look.numbers = NumberLook{};
  ASSERT_TRUE(globe->add_imagery(
      std::make_shared<PaintedNumbers>(kProgramsGrid, [](double lon, double) { return static_cast<float>(lon); }),
      look));
  const auto counts = [&] {
    settle(*globe, kProgramsPicture);
    const auto all = all_programs();
    return std::pair(all.count("patch_plain.frag"), all.count("patch_air.frag"));
  };
  EXPECT_EQ(counts(), std::pair(std::size_t{2}, std::size_t{1}));
  globe->set_surface({.alpha = 0.5, .sharpness = Sharpness::bicubic});
  EXPECT_EQ(counts(), std::pair(std::size_t{3}, std::size_t{1})) << "the picture's alone";
}

TEST_F(Programs, TheSkyBringsAirWithStarsThoseAndWithATimeSunAndMoon) {
  const Names in_air{"limb_air.frag", "patch_oblique.frag", "patch_plain.frag", "patch_polar_long.frag",
                     "sky_air.frag"};
  const auto with = [&](Names names) {
    names.insert(in_air.begin(), in_air.end());
    return names;
  };
  GlobeOptions options;
  options.sky = true;
  EXPECT_EQ(of(options), in_air);
  options.stars = {Star{.direction_j2000 = {1.0F, 0.0F, 0.0F}, .magnitude = 1.0F, .color_linear = {1.0F, 1.0F, 1.0F}}};
  EXPECT_EQ(of(options), with({"sky_star.frag"}));
  options.time = *parse_utc("2026-06-21T12:00Z");
  EXPECT_EQ(of(options), with({"sky_moon.frag", "sky_star.frag", "sky_sun.frag"}));
}

TEST_F(Programs, ObjectsBringTheirsAndMeshesAndLabelsOnlyWhereThereAreAny) {
  for (const std::string& name : more(of({}, {.points = {{.radius_m = 1.0e5}}}))) {
    EXPECT_TRUE(name.starts_with("object_")) << name;
    EXPECT_TRUE(name != "object_mesh.frag" && name != "object_label.frag") << name;
  }
}

}  // namespace
}  // namespace terrella::test
