// Labels, judged by the pixels of their letters.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include "object_canvas.h"
#include "tests/support/label_font.h"

namespace terrella::test {
namespace {

constexpr ObjectColor kYellow{250, 250, 0};

LabelObject label(const std::string& text, double lat_deg, double lon_deg, ObjectColor color = kYellow) {
  return {.text = text, .place = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg)}, .color = color};
}

Camera over_origin(double height_m) {
  Camera camera;
  camera.eye.height_m = height_m;
  return camera;
}

struct Box {
  int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1, pixels = 0;
  void add(int x, int y) {
    left = std::min(left, x), right = std::max(right, x);
    top = std::min(top, y), bottom = std::max(bottom, y);
    ++pixels;
  }
};

/// Around what is mostly ink.
Box ink(const ObjectPicture& picture) {
  Box box;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) {
      if (picture.at(x, y).red > 120) box.add(x, y);
    }
  }
  return box;
}

class LabelPassTest : public ObjectCanvas {
 protected:
  void SetUp() override {
    ObjectCanvas::SetUp();
    font_ = label_font();
    use(DepthMode::reversed, {200, 200});
  }
};

TEST_F(LabelPassTest, StandsRightOfItsMarkerWithAHalo) {
  for (const DepthMode depth : {DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard}) {
    use(depth, {200, 200});
    const ObjectPicture picture = draw({.labels = {label("Helm", 0.0, 0.0)}}, over_origin(1.0e6));
    const Box box = ink(picture);
    // Half a marker of 10 pixels and a gap of 4; the stem of H begins a pixel or two after the pen.
    EXPECT_NEAR(box.left, 110, 2);
    EXPECT_NEAR(box.right, 110 + 40, 6);
    EXPECT_NEAR(0.5 * (box.top + box.bottom), 100.0, 2.0);
    EXPECT_NEAR(box.bottom - box.top + 1, 11, 1) << "capitals of a font of 15 pixels";
    EXPECT_EQ(picture.at(box.left - 1, box.top + 5).red, 0);
    EXPECT_GT(picture.at(box.left - 1, box.top + 5).alpha, 60) << "no halo";
  }
}

TEST_F(LabelPassTest, StaysWithinThePlanetsDisc) {
  use(DepthMode::reversed, {400, 400});
  label_sight_.limb = &ellipsoid();
  const View view = this->view(over_origin(2.0e7));
  const auto text_at = [&](const char* text, double lon_deg, double height_m = 0.0) {
    LabelObject there = label(text, 0.0, lon_deg);
    there.place.height_m = height_m;
    return ink(draw({.labels = {there}}, view));
  };
  const double middle = 0.5 * 400, limb = project(view, ellipsoid().to_ecef(at(0.0, 75.0, 0.0)))->x;
  EXPECT_GT(text_at("Island", 0.0).left, middle) << "right of its place, as long as there is ground";
  EXPECT_GT(text_at("Island", -74.0).left, 400.0 - limb);
  const Box at_limb = text_at("Island", 74.0);
  EXPECT_LT(at_limb.right, limb) << "over the limb";
  EXPECT_GT(at_limb.left, middle);
  EXPECT_GT(text_at("Sat", 60.0, 2.0e6).left, limb) << "of a place in the sky";
}

TEST_F(LabelPassTest, KeepsClearOfASphereOfItsRadius) {
  LabelObject beside = label("I", 0.0, 0.0);
  beside.radius_m = 50.0e3;
  const Box box = ink(draw({.labels = {beside}}, over_origin(1.0e6)));
  EXPECT_NEAR(box.left, 100 + 50.0e3 / 1.0e6 * 274.7 + 4, 3);
}

TEST_F(LabelPassTest, AccentsKerningAndWhatIsNotUtf8) {
  const auto ink_of = [this](const std::string& text) {
    return ink(draw({.labels = {label(text, 0.0, 0.0)}}, over_origin(1.0e6)));
  };
  const Box plain = ink_of("Senor"), accents = ink_of("Señor");
  EXPECT_GT(accents.pixels, plain.pixels + 2);
  EXPECT_LT(ink_of("AVAVAV").right, ink_of("AAAVVV").right - 2) << "letters are not kerned";
  EXPECT_GT(ink_of("Ελλάς Русь").pixels, 60);
  EXPECT_GT(ink_of("\xff\xc3(").pixels, 10) << "what is no text is not shown as such";
  EXPECT_EQ(ink_of("").pixels, 0);
}

TEST_F(LabelPassTest, OfAThousandNoneOverlapsAnotherAndTheFirstStays) {
  use(DepthMode::reversed, {500, 400});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> degrees(-12.0, 12.0);
  ObjectScene scene;
  for (int k = 0; k < 1000; ++k) {
    const auto part = [k](int of) { return static_cast<std::uint8_t>(130 + k / of % 10 * 13); };
    scene.labels.push_back(label("Nmwi", degrees(random), degrees(random), {part(1), part(10), part(100)}));
  }
  scene.labels[700].place = label("", 1.0, 1.0).place;
  scene.labels[700].priority = 2.0;
  const ObjectPicture picture = draw(scene, over_origin(3.0e6));
  std::map<std::tuple<int, int, int>, Box> boxes;
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 500; ++x) {
      const ObjectColor c = picture.at(x, y);
      const auto is_ink = [](int v) { return v >= 130 && (v - 130) % 13 == 0; };
      if (is_ink(c.red) && is_ink(c.green) && is_ink(c.blue)) boxes[{c.red, c.green, c.blue}].add(x, y);
    }
  }
  std::erase_if(boxes, [](const auto& entry) { return entry.second.pixels < 20; });  // mixtures that look like another
  EXPECT_GT(boxes.size(), 40U);
  for (const auto& [color, a] : boxes) {
    for (const auto& [other, b] : boxes) {
      if (color == other) continue;
      ASSERT_FALSE(a.left <= b.right && b.left <= a.right && a.top <= b.bottom && b.top <= a.bottom);
    }
  }
  const ObjectColor first = scene.labels[700].color;
  EXPECT_TRUE(boxes.contains({first.red, first.green, first.blue}));
}

TEST_F(LabelPassTest, HiddenBehindThePlanetAndWithoutText) {
  const auto pixels = [this](double lon_deg, double height_m = 0.0) {
    LabelObject there = label("Hinten", 0.0, lon_deg);
    there.place.height_m = height_m;
    return ink(draw({.labels = {there}}, over_origin(2.0e7))).pixels;
  };
  EXPECT_GT(pixels(180.0), 60) << "nothing hides it";
  label_sight_.hiding_half_axes_m =
      glm::dvec3(0.99999 * ellipsoid().a_m(), 0.99999 * ellipsoid().a_m(), 0.99999 * ellipsoid().b_m());
  EXPECT_EQ(pixels(180.0), 0);
  EXPECT_EQ(pixels(100.0), 0);
  EXPECT_EQ(pixels(0.0, -5.0e3), 0) << "under the ground";
  EXPECT_GT(pixels(0.0), 60);
  EXPECT_GT(pixels(-60.0), 60);
  label_sight_.shown = false;
  EXPECT_EQ(pixels(0.0), 0);
}

TEST_F(LabelPassTest, AFontThatIsNoneIsAnError) {
  const auto made = LabelPass::create(DepthMode::reversed, std::vector<std::byte>(100));
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("font"), std::string::npos);
}

}  // namespace
}  // namespace terrella::test
