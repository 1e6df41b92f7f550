// The globe while its tiles come, do not come, or are too many.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kStreamed{128, 128};

TileGrid deep_grid() { return {.tile_px = 64, .max_level = 8}; }

/// Bright everywhere, and different from place to place.
Color bright(double lon_deg, double row_deg) {
  const auto wave = [](double deg) { return static_cast<std::uint8_t>(170.0 + 80.0 * std::sin(0.3 * deg)); };
  return {wave(lon_deg), wave(row_deg), wave(lon_deg + row_deg)};
}

int dark_pixels(const Picture& picture) {
  int dark = 0;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) dark += picture.at(x, y)[0] < 80 ? 1 : 0;
  }
  return dark;
}

/// Cameras whose whole picture is ground.
std::vector<Camera> ground_cameras() {
  return {camera_at(47, 8, 8.0e5), camera_at(5, 180, 2.0e6, 40, -80), camera_at(89, 0, 1.0e6),
          camera_at(-35, 45, 4.0e5, 10, -60)};
}

class GlobeStreaming : public GlTest {
 protected:
  static std::shared_ptr<PaintedSource> source(const TileGrid& grid = deep_grid(), PaintedSource::Lacks lacks = {}) {
    return std::make_shared<PaintedSource>(grid, bright, std::move(lacks));
  }
};

TEST_F(GlobeStreaming, NeverAHoleWhileTilesComeOneByOne) {
  for (const Camera& camera : ground_cameras()) {
    const auto tiles = source();
    tiles->hold();
    const auto globe = make_globe(unlit_options(), tiles);
    globe->set_camera(camera);
    FrameStats stats = draw(*globe, kStreamed);
    EXPECT_GT(stats.patches_uncovered, 0);
    int after_roots = 0;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(50);
    while (!globe->settled() && std::chrono::steady_clock::now() < deadline) {
      // Released tiles must not pile up and come at once, even if other work starves the workers or the upload.
      const auto coming = [&] {
        const LoaderCounts counts = globe->loading();
        return counts.finished == 0 && counts.waiting + counts.running > 0;
      };
      if (coming()) tiles->release(1);
      for (int wait = 0; wait < 5000 && coming(); ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      stats = draw(*globe, kStreamed);
      if (after_roots == 0 && stats.patches_uncovered > 0) continue;
      ++after_roots;
      ASSERT_EQ(stats.patches_uncovered, 0);
      ASSERT_EQ(dark_pixels(picture()), 0) << "after " << tiles->reads() << " tiles";
    }
    EXPECT_TRUE(globe->settled());
    EXPECT_GT(after_roots, 4);
    EXPECT_EQ(stats.tiles_pending, 0);
    tiles->release(1000);
  }
}

TEST_F(GlobeStreaming, SettlesAndThenStandsStill) {
  for (const Camera& camera : ground_cameras()) {
    std::vector<std::uint8_t> first;
    for (int run = 0; run < 2; ++run) {
      const auto globe = make_globe(unlit_options(), source());
      globe->set_camera(camera);
      const FrameStats stats = settle(*globe, kStreamed);
      EXPECT_TRUE(globe->settled());
      EXPECT_EQ(stats.tiles_pending, 0);
      EXPECT_EQ(stats.uploaded_bytes, 0U);
      const auto settled = picture().rgba;
      draw(*globe, kStreamed);
      EXPECT_EQ(picture().rgba, settled) << "a second frame differs";
      if (run == 0) first = settled;
      EXPECT_EQ(settled, first) << "a second run differs";
    }
  }
}

TEST_F(GlobeStreaming, SettlesInThreeFramesAfterTheLastTileHasArrived) {
  for (const Camera& camera : ground_cameras()) {
    const auto tiles = source();
    tiles->hold();
    GlobeOptions options = unlit_options();
    // Bounded in bytes alone: what four milliseconds upload is for the machine to say.
    options.upload_time_per_frame = std::chrono::seconds(1);
    const auto globe = make_globe(options, tiles);
    globe->set_camera(camera);
    draw(*globe, kStreamed);
    tiles->release(1000);
    for (LoaderCounts left = globe->loading(); left.waiting + left.running > 0; left = globe->loading()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_GT(globe->loading().finished, 4U);
    int frames = 0;
    for (; !globe->settled() && frames < 10; ++frames) draw(*globe, kStreamed);
    EXPECT_LE(frames, 3);
  }
}

TEST_F(GlobeStreaming, APictureDoesNotDependOnWhatWasSeenBefore) {
  const auto traveller = make_globe(unlit_options(), source());
  for (const Camera& camera : ground_cameras()) {
    traveller->set_camera(camera);
    settle(*traveller, kStreamed);
    const auto after_a_journey = picture().rgba;
    const auto fresh = make_globe(unlit_options(), source());
    fresh->set_camera(camera);
    settle(*fresh, kStreamed);
    EXPECT_EQ(picture().rgba, after_a_journey);
  }
}

TEST_F(GlobeStreaming, SettlesOnASmallBudgetWithoutHoles) {
  for (const std::size_t budget : {std::size_t{1}, std::size_t{600} << 10U, std::size_t{2} << 20U}) {
    GlobeOptions options = unlit_options();
    options.gpu_bytes = budget;
    const auto globe = make_globe(options, source());
    for (const Camera& camera : ground_cameras()) {
      globe->set_camera(camera);
      const FrameStats stats = settle(*globe, {256, 256});
      EXPECT_EQ(stats.patches_uncovered, 0);
      EXPECT_EQ(dark_pixels(picture()), 0);
    }
  }
}

TEST_F(GlobeStreaming, TheRootTilesAreKeptWhateverComes) {
  GlobeOptions options = unlit_options();
  options.gpu_bytes = 1;
  const auto tiles = source();
  const auto globe = make_globe(options, tiles);
  for (const Camera& camera : ground_cameras()) {
    globe->set_camera(camera);
    settle(*globe, kStreamed);
  }
  // Nothing more comes: only what is kept can be drawn.
  tiles->hold();
  globe->set_camera(camera_at(-10, -100, 5.0e5));
  EXPECT_EQ(draw(*globe, kStreamed).patches_uncovered, 0);
  EXPECT_EQ(dark_pixels(picture()), 0);
  tiles->release(1000);
}

TEST_F(GlobeStreaming, AncestorsStandInForTilesThatTheSourceLacks) {
  const auto some = [](const TileId& id) { return id.level > 0 && TileIdHash()(id) % 3 == 0; };
  for (const Camera& camera : ground_cameras()) {
    const auto globe = make_globe(unlit_options(), source(deep_grid(), some));
    globe->set_camera(camera);
    const FrameStats stats = settle(*globe, kStreamed);
    EXPECT_GT(stats.tiles_missing, 0);
    EXPECT_EQ(stats.tiles_pending, 0);
    EXPECT_EQ(stats.patches_uncovered, 0);
    EXPECT_EQ(dark_pixels(picture()), 0);
  }
}

TEST_F(GlobeStreaming, SettlesWhereThereIsNoImageryAtAll) {
  TileGrid europe = deep_grid();
  europe.min_level = 3;
  europe.bounds = {Angle::degrees(-10), Angle::degrees(35), Angle::degrees(40), Angle::degrees(70)};
  const auto everything = [](const TileId&) { return true; };
  for (const auto& tiles : {source(europe), source(deep_grid(), everything)}) {
    const auto globe = make_globe(unlit_options(), tiles);
    globe->set_camera(camera_at(-40, -120, 2.0e6));
    settle(*globe, kStreamed);
    globe->set_camera(camera_at(47, 8, 2.0e7));
    settle(*globe, kStreamed);
  }
}

TEST_F(GlobeStreaming, AFrameTakesFewDrawCalls) {
  Draw draws(61);
  for (const Texturing texturing : {Texturing::automatic, Texturing::paper, Texturing::exact, Texturing::vertex}) {
    GlobeOptions options = unlit_options();
    options.texturing = texturing;
    const auto globe = make_globe(options, source());
    for (int k = 0; k < 30; ++k) {
      globe->set_camera(random_camera(draws, 10.0, 1.0e8));
      const FrameStats stats = draw(*globe, kStreamed);
      EXPECT_LE(stats.draw_calls, 10);
      EXPECT_GE(stats.patches, stats.band_patches);
    }
  }
}

TEST_F(GlobeStreaming, UploadsStayWithinTheBudgetOfAFrame) {
  GlobeOptions options = unlit_options();
  options.upload_bytes_per_frame = 1;
  const auto tiles = source();
  const auto globe = make_globe(options, tiles);
  globe->set_camera(camera_at(47, 8, 8.0e5));
  std::size_t least = SIZE_MAX, most = 0;
  for (int k = 0; k < 400 && !globe->settled(); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::size_t bytes = draw(*globe, kStreamed).uploaded_bytes;
    if (bytes > 0) least = std::min(least, bytes);
    most = std::max(most, bytes);
  }
  EXPECT_TRUE(globe->settled());
  EXPECT_EQ(most, least) << "more than one tile in a frame";
}

/// Names of live objects of a kind, by asking for the first few thousand.
int live(GLboolean (*is)(GLuint)) {
  int count = 0;
  for (GLuint name = 1; name < 4096; ++name) count += is(name) == GL_TRUE ? 1 : 0;
  return count;
}
std::array<int, 6> live_objects() {
  return {live([](GLuint n) { return glIsTexture(n); }),     live([](GLuint n) { return glIsBuffer(n); }),
          live([](GLuint n) { return glIsProgram(n); }),     live([](GLuint n) { return glIsShader(n); }),
          live([](GLuint n) { return glIsFramebuffer(n); }), live([](GLuint n) { return glIsVertexArray(n); })};
}

TEST_F(GlobeStreaming, AGlobeThatIsGoneLeavesNoObjectBehind) {
  draw(*make_globe(unlit_options(), source()), kStreamed);
  const auto before = live_objects();
  {
    const auto globe = make_globe(unlit_options(), source());
    globe->set_camera(camera_at(47, 8, 8.0e5));
    settle(*globe, kStreamed);
    EXPECT_NE(live_objects(), before);
  }
  EXPECT_EQ(live_objects(), before);
}

}  // namespace
}  // namespace terrella::test
