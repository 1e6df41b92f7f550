// The contract of the Globe API: each range that a public header states is checked, at both of its ends, and a value
// out of it is an error that names the call and the value. tests/structure finds ranges without a row here.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "tests/facade/ranges.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"
#include "tiles/painted_tiles.h"

namespace terrella::test {
namespace {

constexpr Viewport kRangePicture{16, 16};
const std::vector<Row<SurfaceLook>> kSurfaceRows = {
    {"alpha", {0.0, 1.0}, {-0.1, 1.1, kNoNumberAtAll}, [](SurfaceLook& s, double v) { s.alpha = v; }},
    {"inner_sphere_below_m",
     {0.0, 6378137.0},
     {-1.0, 6378138.0, 1e308, kNoNumberAtAll},
     [](SurfaceLook& s, double v) { s.inner_sphere_below_m = v; }},
    {"blend", {0, 1}, {-1, 2}, [](SurfaceLook& s, double v) { s.blend = Blend(int(v)); }},
    {"from_below", {0, 2}, {-1, 3}, [](SurfaceLook& s, double v) { s.from_below = SurfaceFromBelow(int(v)); }},
    {"horizon_culling", {0, 2}, {-1, 3}, [](SurfaceLook& s, double v) { s.horizon_culling = HorizonCulling(int(v)); }},
    {"sharpness", {0, 2}, {-1, 3}, [](SurfaceLook& s, double v) { s.sharpness = Sharpness(int(v)); }},
    {"swipe", {0.0, 1.0}, {-0.1, 1.1, kNoNumberAtAll}, [](SurfaceLook& s, double v) { s.swipe = v; }},
    {"inner_sphere_srgb", {0.0, 1.0}, {-0.1, 1.1, kNoNumberAtAll}, [](SurfaceLook& s, double v) {
       s.inner_sphere_srgb = glm::vec3(float(v));
     }}};
const std::vector<Row<StereoLook>> kStereoRows = {
    {"mode", {0, 3}, {-1, 4}, [](StereoLook& s, double v) { s.mode = Stereo(int(v)); }},
    {"eye_separation_m", {0.0, 1e9}, {-1.0, 1.1e9, kNoNumberAtAll}, [](StereoLook& s, double v) {
       s.eye_separation_m = v;
     }}};

class Ranges : public GlTest {
 protected:
  [[nodiscard]] static std::unique_ptr<Globe> globe() { return make_globe({}, one_colour(kRangeGrid, {0, 200, 0})); }
  /// The error of a setting that returns none: status() at once, and the next frame draws nothing.
  static Status refusal_of(Globe& globe) {
    if (globe.status()) return Done{};
    const Status refused = globe.status();
    const OffscreenTarget target(kRangePicture);
    EXPECT_EQ(globe.render(target.framebuffer(), kRangePicture).patches, 0);
    EXPECT_EQ(message_in(globe.status()), message_in(refused));
    EXPECT_GT(globe.render(target.framebuffer(), kRangePicture).patches, 0);
    EXPECT_TRUE(globe.status());
    return refused;
  }
};

TEST_F(Ranges, OfOptions) {
  using O = GlobeOptions;
  using std::chrono::hours, std::chrono::milliseconds;
  const double day_ms = 24.0 * 3600e3;
  std::vector<Row<O>> rows = {
      {"texturing", {0, 3}, {-1, 4}, [](O& o, double v) { o.texturing = Texturing(int(v)); }},
      {"depth", {0, 2}, {-1, 3}, [](O& o, double v) { o.depth = DepthMode(int(v)); }},
      {"gl_contract", {0, 1}, {-1, 2}, [](O& o, double v) { o.gl_contract = GlContract(int(v)); }},
      {"polar_columns", {1, 4096}, {-1, 0, 4097}, [](O& o, double v) { o.polar_columns = int(v); }},
      {"texels_per_pixel",
       {0.125, 8.0},
       {0.1, 8.1, kNoNumberAtAll, kInfinite},
       [](O& o, double v) { o.texels_per_pixel = v; }},
      {"max_error_px", {0.01, 16.0}, {0.0, 16.1, kNoNumberAtAll}, [](O& o, double v) { o.max_error_px = v; }},
      {"segments", {2, 128}, {-2, 0, 3, 130}, [](O& o, double v) { o.segments = int(v); }},
      {"gutter_px", {0, 64}, {-1, 65}, [](O& o, double v) { o.gutter_px = int(v); }},
      {"exaggeration",
       {0.0, 100.0},
       {-0.1, 100.1, kNoNumberAtAll, kInfinite},
       [](O& o, double v) { o.exaggeration = v; }},
      {"workers", {0, 64}, {-1, 65}, [](O& o, double v) { o.workers = int(v); }},
      {"upload_bytes_per_frame", {1}, {0}, [](O& o, double v) { o.upload_bytes_per_frame = std::size_t(v); }},
      {"upload_time_per_frame",
       {0.0, day_ms},
       {-1.0, day_ms + 1.0},
       [](O& o, double v) { o.upload_time_per_frame = milliseconds(long(v)); }},
      {"relief_meshes_per_frame", {1}, {-1, 0}, [](O& o, double v) { o.relief_meshes_per_frame = int(v); }},
      {"retry_after",
       {1, 365.0 * day_ms},
       {-1, 0, 366.0 * day_ms},
       [](O& o, double v) { o.retry_after = milliseconds(long(v)); }},
      {"a",
       {1.0, 1e10},
       {0.0, -1.0, 1.1e10, kNoNumberAtAll},
       [](O& o, double v) { o.body.ellipsoid = Ellipsoid(v, 0.0); }},
      {"f", {0.0, 0.49}, {-0.1, 0.5, kNoNumberAtAll}, [](O& o, double v) { o.body.ellipsoid = Ellipsoid(6e6, v); }},
      {"night_lights",
       {8, 8},
       {0, 7},
       [](O& o, double v) {
         o.night_lights = {4, 2, std::vector<std::uint8_t>(std::size_t(v) + (v == 0 ? 1 : 0))};
       }},
      {"stars", {1.0}, {kNoNumberAtAll}, [](O& o, double v) {
         o.stars = {{.direction_j2000 = {float(v), 0.0F, 0.0F}, .magnitude = 1.0F, .color_linear = {}}};
       }}};
  for (const auto& row : kSurfaceRows)
    rows.push_back({row.name, row.good, row.bad, [row](O& o, double v) { row.set(o.surface, v); }});
  for (const auto& row : kStereoRows)
    rows.push_back({row.name, row.good, row.bad, [row](O& o, double v) { row.set(o.stereo, v); }});
  expect_ranges<O>({}, rows, "Globe::create: ", [](const O& options) {
    const auto made = Globe::create(options);
    return made ? Status(Done{}) : made.error();
  });
}

TEST_F(Ranges, OfSettings) {
  const auto planet = globe();
  expect_ranges<SurfaceLook>({}, kSurfaceRows, "Globe::set_surface: ", [&](const SurfaceLook& look) {
    planet->set_surface(look);
    EXPECT_EQ(planet->status().ok(), planet->options().surface == look);
    return refusal_of(*planet);
  });
  expect_ranges<StereoLook>({}, kStereoRows, "Globe::set_stereo: ", [&](const StereoLook& look) {
    planet->set_stereo(look);
    return refusal_of(*planet);
  });
  expect_ranges<double>(
      1.0, {{"exaggeration", {0.0, 100.0}, {-1.0, 100.1, kNoNumberAtAll}, [](double& e, double v) { e = v; }}},
      "Globe::set_exaggeration: ", [&](double factor) {
        planet->set_exaggeration(factor);
        return refusal_of(*planet);
      });
  expect_ranges<GlobeBudget>(
      {1UL << 20, 1UL << 20, std::chrono::microseconds(1), 1},
      {{"relief_meshes_per_frame", {1}, {0}, [](GlobeBudget& b, double v) { b.relief_meshes_per_frame = int(v); }},
       {"upload_bytes_per_frame",
        {1},
        {0},
        [](GlobeBudget& b, double v) { b.upload_bytes_per_frame = std::size_t(v); }}},
      "Globe::set_budget: ", [&](const GlobeBudget& budget) {
        planet->set_budget(budget);
        return refusal_of(*planet);
      });
}

TEST_F(Ranges, OfCameras) {
  const auto planet = globe();
  const auto view = std::move(*GlobeView::create(*planet));
  std::vector<Row<Camera>> rows = place_rows<Camera>([](Camera& c) -> Geodetic& { return c.eye; });
  rows.push_back({"heading", {-1000.0, 1000.0}, {kNoNumberAtAll, kInfinite}, [](Camera& c, double v) {
                    c.heading = Angle::degrees(v);
                  }});
  rows.push_back({"pitch", {-90.0, 90.0}, {-91.0, 91.0, kNoNumberAtAll}, [](Camera& c, double v) {
                    c.pitch = Angle::degrees(v);
                  }});
  rows.push_back({"fov_y", {0.01, 170.0}, {-1.0, 0.0, 171.0, kNoNumberAtAll}, [](Camera& c, double v) {
                    c.fov_y = Angle::degrees(v);
                  }});
  expect_ranges<Camera>({}, rows, "Globe::set_camera: ", [&](const Camera& camera) {
    planet->set_camera(camera);
    EXPECT_EQ(planet->status().ok(), planet->camera() == camera);
    const Status set = planet->status();
    planet->set_camera({});
    return set ? set : refusal_of(*planet);
  });
  expect_ranges<Camera>({}, rows, "GlobeView::set_camera: ", [&](const Camera& camera) {
    view->set_camera(camera);
    const Status set = view->status();
    const OffscreenTarget target(kRangePicture);
    view->set_camera({});
    view->render(target.framebuffer(), kRangePicture);
    view->render(target.framebuffer(), kRangePicture);
    return set;
  });
}

TEST_F(Ranges, OfFrames) {
  struct Frame {
    Viewport size = kRangePicture;
    glm::ivec2 corner_px{0};
  };
  const auto planet = globe();
  const OffscreenTarget target(kRangePicture);
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  const std::vector<Row<Frame>> rows = {
      {"width_px", {1, 16}, {-1, 0, most + 1.0, 1e9}, [](Frame& f, double v) { f.size.width_px = int(v); }},
      {"height_px", {1, 16}, {-1, 0, most + 1.0}, [](Frame& f, double v) { f.size.height_px = int(v); }},
      {"corner_px", {-1e6, 1e6}, {-2e9, 2e9}, [](Frame& f, double v) { f.corner_px = glm::ivec2(int(v)); }}};
  expect_ranges<Frame>({}, rows, "Globe::render: ", [&](const Frame& frame) {
    planet->render(target.framebuffer(), frame.size, frame.corner_px);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    return planet->status();
  });
  planet->render(target.framebuffer(), kRangePicture);
  EXPECT_FALSE(planet->pick({8.0, 8.0}, {0, 5}).place);
  EXPECT_FALSE(planet->pick({kNoNumberAtAll, 8.0}, kRangePicture).place);
  EXPECT_FALSE(planet->project({.lat = Angle::degrees(kNoNumberAtAll), .lon = {}}, kRangePicture));
  EXPECT_FALSE(planet->project(kRangePlace, {-1, -1}));
  EXPECT_EQ(planet->view({0, -5}).viewport, (Viewport{1, 1}));
  EXPECT_EQ(planet->ground_height_m(Angle::degrees(kNoNumberAtAll), {}), 0.0);
  EXPECT_FALSE(planet->elevation_m(Angle::degrees(kNoNumberAtAll), {}));
}

TEST_F(Ranges, OfImageLayers) {
  const auto planet = globe();
  const std::vector<Row<ImageLook>> looks = {
      {"opacity", {0.0, 1.0}, {-0.1, 1.1, kNoNumberAtAll}, [](ImageLook& l, double v) { l.opacity = v; }},
      {"min_level", {0, kMaxTileLevel}, {-1, kMaxTileLevel + 1}, [](ImageLook& l, double v) { l.min_level = int(v); }},
      {"max_level", {0, kMaxTileLevel}, {-1, kMaxTileLevel + 1}, [](ImageLook& l, double v) { l.max_level = int(v); }},
      {"daylight", {0, 2}, {-1, 3}, [](ImageLook& l, double v) { l.daylight = Daylight(int(v)); }},
      {"alpha", {0, 1}, {-1, 2}, [](ImageLook& l, double v) { l.alpha = AlphaFrom(int(v)); }},
      {"swipe", {0, 2}, {-1, 3}, [](ImageLook& l, double v) { l.swipe = SwipeSide(int(v)); }},
      {"clock", {0, 2}, {-1, 3}, [](ImageLook& l, double v) { l.clock = LayerClock(int(v)); }},
      {"blend", {0, 3}, {-1, 4}, [](ImageLook& l, double v) { l.blend = LayerBlend(int(v)); }},
      {"brightness", {-1.0, 1.0}, {-1.1, 1.1, kNoNumberAtAll}, [](ImageLook& l, double v) { l.tone.brightness = v; }},
      {"contrast", {0.0, 4.0}, {-0.1, 4.1, kNoNumberAtAll}, [](ImageLook& l, double v) { l.tone.contrast = v; }},
      {"gamma", {0.1, 10.0}, {0.0, 10.1, kNoNumberAtAll}, [](ImageLook& l, double v) { l.tone.gamma = v; }},
      {"height_m", {0.0, 1e6}, {-1.0, 1.1e6, kNoNumberAtAll}, [](ImageLook& l, double v) { l.height_m = v; }}};
  expect_ranges<ImageLook>({}, looks, "Globe::set_look: ", [&](const ImageLook& look) {
    return planet->set_look(planet->imagery().front(), look);
  });
  const auto add = [&](std::shared_ptr<TileSource> source, const ImageLook& look) {
    const auto added = planet->add_imagery(std::move(source), look);
    if (!added) return Status(added.error());
    return planet->remove(*added);
  };
  expect_ranges<ImageLook>({}, looks, "Globe::add_imagery: ", [&](const ImageLook& look) {
    return add(one_colour(kRangeGrid, {1, 2, 3}), look);
  });
  const std::vector<Row<TileGrid>> grids = {
      {"root_span_deg",
       {2.0, 1e4},
       {0.0, -1.0, 1.1e4, kNoNumberAtAll},
       [](TileGrid& g, double v) { g.root_span_deg = v; }},
      {"tile_px", {16, 4096}, {-1, 0, 15, 4097}, [](TileGrid& g, double v) { g.tile_px = int(v); }},
      {"min_level", {0, 1}, {-1, 2}, [](TileGrid& g, double v) { g.min_level = int(v); }},
      {"max_level", {0, kMaxTileLevel}, {-1, kMaxTileLevel + 1}, [](TileGrid& g, double v) { g.max_level = int(v); }},
      {"bounds",
       {-90.0, 0.0},
       {-91.0, 90.0, kNoNumberAtAll},
       [](TileGrid& g, double v) { g.bounds.south = Angle::degrees(v); }},
      {"west_deg", {-180.0, -200.0}, {-179.0, -361.0, kNoNumberAtAll}, [](TileGrid& g, double v) { g.west_deg = v; }},
      {"north_deg", {90.0, 100.0}, {89.0, 271.0, kNoNumberAtAll}, [](TileGrid& g, double v) { g.north_deg = v; }},
      {"projection", {0, 1}, {2, 3}, [](TileGrid& g, double v) { g.projection = static_cast<Projection>(int(v)); }}};
  const TilePainter paint = [](const TileId&) { return Image{}; };
  expect_ranges<TileGrid>(kRangeGrid, grids, "Globe::add_imagery: ", [&](const TileGrid& grid) {
    const auto tiles = painted_tiles(grid, paint);
    static_cast<void>(tiles->read({}));
    static_cast<void>(ElevationSource::open(tiles, "heights"));
    return add(tiles, {});
  });
  EXPECT_EQ(painted_tiles(kRangeGrid, nullptr), nullptr);
  EXPECT_FALSE(ElevationSource::open(nullptr, "heights"));
  ImageLook numbers;
  numbers.numbers = NumberLook{};
  expect_ranges<NumberInfo>(
      {.floats = true},
      {{"scale", {-1.0, 1.0}, {0.0, kNoNumberAtAll, kInfinite}, [](NumberInfo& n, double v) { n.scale = v; }},
       {"offset", {-1e9}, {kNoNumberAtAll, kInfinite}, [](NumberInfo& n, double v) { n.offset = v; }},
       {"period", {0.0, 1e9}, {-1.0, 1.1e9, kNoNumberAtAll}, [](NumberInfo& n, double v) { n.period = v; }},
       {"most",
        {0, 5},
        {-1},
        [](NumberInfo& n, double v) {
          n.whole = WholeRange{0, int(v)};
        }}},
      "Globe::add_imagery: ", [&](const NumberInfo& info) {
        return add(std::make_shared<PaintedNumbers>(
                       kRangeGrid, [](double, double) { return 0.0F; }, info),
                   numbers);
      });
}

// A picture that a painter makes is checked before a pixel of it is read.
TEST_F(Ranges, OfPaintedPictures) {
  for (const Image& wrong :
       {Image{16, 16, std::vector<std::uint8_t>(100)}, Image{16, 16, {}}, Image{0, 0, {}},
        Image{-16, -16, std::vector<std::uint8_t>(1024)}, Image{16, 8, std::vector<std::uint8_t>(512)},
        Image{16, 16, std::vector<std::uint8_t>(1025)}}) {
    const auto planet =
        make_globe(unlit_options(), painted_tiles(kRangeGrid, [wrong](const TileId&) { return wrong; }));
    settle(*planet, kRangePicture);
    ASSERT_FALSE(planet->missing_tiles().empty());
    EXPECT_EQ(planet->missing_tiles().back().failure.kind, MissingKind::broken);
    EXPECT_FALSE(encode_png(wrong) && wrong.width_px == 16 && wrong.height_px == 16);
    EXPECT_EQ(encode_jpeg(wrong, 90).ok(), wrong.height_px == 8);
    EXPECT_EQ(encode_webp(wrong, 90).ok(), wrong.height_px == 8);
  }
  const Image one{1, 1, std::vector<std::uint8_t>(4, 255)};
  for (const int quality : {-1, 0, 101}) EXPECT_FALSE(encode_jpeg(one, quality) || encode_webp(one, quality));
}

}  // namespace
}  // namespace terrella::test
