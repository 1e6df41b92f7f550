// Several views of one globe share its tiles, and each behaves as if it were alone.
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "globe/globe_view.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"
#include "tests/support/leaks.h"

namespace terrella::test {
namespace {

constexpr Viewport kMainView{96, 96};
constexpr Viewport kMapView{48, 48};
const TileGrid kViewGrid{.tile_px = 32, .max_level = 8};
constexpr std::chrono::minutes kSettles{2};

std::shared_ptr<PaintedSource> painted_land() {
  return std::make_shared<PaintedSource>(kViewGrid, [](double lon, double row) {
    return Color{static_cast<std::uint8_t>(128 + 0.6 * lon), static_cast<std::uint8_t>(128 + row), 60};
  });
}

double view_hills_m(double lat_rad, double lon_rad) {
  return 2000.0 * std::sin(40.0 * lat_rad) * std::cos(40.0 * lon_rad);
}

/// A view to draw, and how it settles.
struct Drawn {
  GlobeView* view;
  Viewport size;
  std::unique_ptr<OffscreenTarget> target = std::make_unique<OffscreenTarget>(size);
  int frames_to_settle = 0;
  FrameStats stats = {};
};

class Views : public GlTest {
 protected:
  static std::unique_ptr<Globe> globe_of(const std::shared_ptr<TileSource>& source, bool relief = false,
                                         GlobeOptions options = {}) {
    options.workers = 1;
    std::optional<ElevationSource> heights;
    if (relief) {
      auto opened = ElevationSource::open(painted_heights({.tile_px = 32, .max_level = 6}, view_hills_m), "hills");
      EXPECT_TRUE(opened);
      heights = *std::move(opened);
    }
    auto globe = Globe::create(options, source, heights);
    EXPECT_TRUE(globe) << globe.error().message;
    return *std::move(globe);
  }
  static std::unique_ptr<GlobeView> view_of(Globe& globe, const Camera& camera) {
    auto view = GlobeView::create(globe);
    EXPECT_TRUE(view) << view.error().message;
    (*view)->set_camera(camera);
    return *std::move(view);
  }
  /// Draws the views in turn, each while it needs frames, until all are settled. In a round no tile comes before all
  /// views have asked, and the next round begins when all tiles have come: frames and requests can be counted.
  static void settle_all(Globe& globe, std::vector<Drawn>& all, PaintedSource* source = nullptr) {
    const auto deadline = std::chrono::steady_clock::now() + kSettles;
    const auto is_done = [](const Drawn& one) { return one.view->settled() && !one.view->needs_frame(); };
    while (!std::ranges::all_of(all, is_done)) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "not settled";
      if (source != nullptr) source->hold();
      for (Drawn& one : all) {
        if (is_done(one)) continue;
        one.stats = one.view->render(one.target->framebuffer(), one.size);
        ++one.frames_to_settle;
      }
      if (source != nullptr) source->release(1000);
      while (globe.loading().waiting + globe.loading().running > 0) std::this_thread::yield();
    }
  }
  static std::vector<Drawn> drawn(std::initializer_list<GlobeView*> views) {
    std::vector<Drawn> all;
    for (GlobeView* view : views) all.push_back({view, all.empty() ? kMainView : kMapView});
    return all;
  }
};

const Camera kNearView = camera_at(46, 7, 3.0e5);
const Camera kOverView = camera_at(46, 7, 1.2e7);
const Camera kFarView = camera_at(-20, -130, 3.0e5);

// An overview map, a view of the other side, and the same view twice: requests, frames and pictures.
/// Bytes that differ between two pictures by more than a rounding: heights that another view wants refine a relief's
/// bounds.
std::ptrdiff_t unlike(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  if (a.size() != b.size()) return -1;
  return std::inner_product(a.begin(), a.end(), b.begin(), std::ptrdiff_t{0}, std::plus<>{},
                            [](int x, int y) { return std::abs(x - y) > 1; });
}

TEST_F(Views, EachSettlesAsFastAsAloneAndLooksAsItDoesAlone) {
  for (const bool relief : {false, true}) {
    for (const Camera& second : {kOverView, kFarView, kNearView}) {
      SCOPED_TRACE(testing::Message() << "second view at " << second.eye.height_m << " m"
                                      << (relief ? ", relief" : ""));
      const auto alone = [&](const Camera& camera, Viewport size, int& reads) {
        const auto source = painted_land();
        const auto globe = globe_of(source, relief);
        globe->set_camera(camera);
        std::vector<Drawn> one = drawn({&globe->main_view()});
        one.front().size = size;
        one.front().target = std::make_unique<OffscreenTarget>(size);
        settle_all(*globe, one, source.get());
        reads = source->reads();
        return std::pair(one.front().frames_to_settle, one.front().target->read());
      };
      int first_reads = 0, second_reads = 0;
      const auto [first_frames, first_picture] = alone(kNearView, kMainView, first_reads);
      const auto [second_frames, second_picture] = alone(second, kMapView, second_reads);

      const auto source = painted_land();
      const auto globe = globe_of(source, relief);
      globe->set_camera(kNearView);
      const auto further = view_of(*globe, second);
      std::vector<Drawn> both = drawn({&globe->main_view(), further.get()});
      settle_all(*globe, both, source.get());
      EXPECT_LE(both[0].frames_to_settle, first_frames + 1 + first_frames / 10);
      EXPECT_LE(both[1].frames_to_settle, second_frames + 1 + second_frames / 10);
      EXPECT_LE(source->reads(), first_reads + second_reads) << "tiles were read again";
      EXPECT_EQ(unlike(both[0].target->read(), first_picture), 0);
      EXPECT_EQ(unlike(both[1].target->read(), second_picture), 0);
      // Nothing evicts anything: many frames later both are as they were, and nothing was read.
      const int reads = source->reads();
      for (int k = 0; k < 5; ++k) {
        for (Drawn& one : both) {
          one.stats = one.view->render(one.target->framebuffer(), one.size);
          EXPECT_EQ(one.stats.tiles_pending, 0);
          EXPECT_EQ(one.stats.relief_meshes, 0);
        }
      }
      EXPECT_EQ(source->reads(), reads);
      EXPECT_FALSE(globe->needs_frame());
      EXPECT_FALSE(further->needs_frame());
    }
  }
}

/// Bytes of all buffers and textures that there are, as OpenGL has them.
std::int64_t gpu_bytes() {
  std::int64_t bytes = 0;
  for (GLuint name = 1; name < 5000; ++name) {
    if (glIsBuffer(name)) {
      GLint64 size = 0;
      glGetNamedBufferParameteri64v(name, GL_BUFFER_SIZE, &size);
      bytes += size;
    }
    if (!glIsTexture(name)) continue;
    GLint of_buffer = 0, levels = 0;
    glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_BUFFER_SIZE, &of_buffer);
    if (of_buffer > 0) continue;  // counted as a buffer
    glGetTextureParameteriv(name, GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
    for (GLint level = 0; level < levels; ++level) {
      const auto value = [&](GLenum what) {
        GLint is = 0;
        glGetTextureLevelParameteriv(name, level, what, &is);
        return std::int64_t{is};
      };
      std::int64_t bits = 0;
      for (const GLenum part : {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
                                GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE}) {
        bits += value(part);
      }
      bytes += value(GL_TEXTURE_WIDTH) * value(GL_TEXTURE_HEIGHT) * value(GL_TEXTURE_DEPTH) *
               std::max(value(GL_TEXTURE_SAMPLES), std::int64_t{1}) * bits / 8;
    }
  }
  return bytes;
}

// Vertices, targets and slopes are shared as tiles are. Each view has only lists and the air of its eye.
TEST_F(Views, OfTheSameTilesTakeATenthMoreMemoryOfTheGpu) {
  constexpr Viewport kLarge{640, 360};
  for (const bool relief : {false, true}) {
    GlobeOptions options;
    options.sky = true;
    const auto globe = globe_of(painted_land(), relief, options);
    globe->set_camera(kNearView);
    const auto twin = view_of(*globe, kNearView);
    std::vector<Drawn> one = drawn({&globe->main_view()}), both = drawn({&globe->main_view(), twin.get()});
    for (Drawn* view : {&one[0], &both[0], &both[1]}) {
      view->size = kLarge;
      view->target = std::make_unique<OffscreenTarget>(kLarge);
    }
    const std::int64_t of_application = 3L * 4 * kLarge.width_px * kLarge.height_px;
    settle_all(*globe, one);
    const std::int64_t alone = gpu_bytes() - of_application;
    settle_all(*globe, both);
    globe->render(both[0].target->framebuffer(), kLarge);
    const auto times = static_cast<double>(gpu_bytes() - of_application) / static_cast<double>(alone);
    RecordProperty(relief ? "times_relief" : "times", std::to_string(times));
    EXPECT_LE(times, 1.1) << (relief ? "with" : "without") << " relief";
    EXPECT_EQ(both[0].target->read(), both[1].target->read());
  }
}

// Views of one size share their targets, so a depth is a view's own until another view draws.
TEST_F(Views, DepthIsCopiedBeforeAnotherViewDraws) {
  const OffscreenTarget target(kMapView);
  const gl::Texture target_depth = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(target_depth.name(), 1, GL_DEPTH_COMPONENT32F, kMapView.width_px, kMapView.height_px);
  glNamedFramebufferTexture(target.framebuffer(), GL_DEPTH_ATTACHMENT, target_depth.name(), 0);
  const auto globe = globe_of(painted_land());
  globe->set_camera(kNearView);
  const auto other = view_of(*globe, kFarView);
  EXPECT_FALSE(globe->copy_depth(target.framebuffer())) << "nothing has been drawn";
  globe->render(target.framebuffer(), kMapView);
  const unsigned depth = globe->depth_texture();
  EXPECT_NE(depth, 0U);
  EXPECT_TRUE(globe->copy_depth(target.framebuffer()));
  other->render(target.framebuffer(), kMapView);
  EXPECT_EQ(globe->depth_texture(), 0U);
  EXPECT_EQ(other->depth_texture(), depth);
  const Status late = globe->copy_depth(target.framebuffer());
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("another view of the globe has been drawn since; copy"), std::string::npos);
  EXPECT_TRUE(other->copy_depth(target.framebuffer()));
}

TEST_F(Views, ShareTheTexturesOfTiles) {
  const auto source = painted_land();
  const auto globe = globe_of(source);
  globe->set_camera(kNearView);
  std::vector<Drawn> one = drawn({&globe->main_view()});
  settle_all(*globe, one);
  const int reads = source->reads();
  const auto twin = view_of(*globe, kNearView);
  std::vector<Drawn> both = drawn({&globe->main_view(), twin.get()});
  both[1].size = kMainView;
  both[1].target = std::make_unique<OffscreenTarget>(kMainView);
  settle_all(*globe, both);
  EXPECT_EQ(both[1].frames_to_settle, 1) << "all of its tiles are there";
  EXPECT_EQ(source->reads(), reads);
  EXPECT_LE(static_cast<double>(both[1].stats.gpu_bytes), 1.1 * static_cast<double>(one[0].stats.gpu_bytes));
  EXPECT_EQ(both[1].stats.tiles_known, one[0].stats.tiles_known);
  EXPECT_EQ(both[1].target->read(), one[0].target->read());
}

// With slots for fewer tiles than both views want, both are coarser, both settle, and neither takes turns with the
// other.
TEST_F(Views, DivideTheRoomForTiles) {
  const auto source = painted_land();
  GlobeOptions options;
  options.gpu_bytes = 22UL * 48 * 48 * 4 * 4 / 3;
  options.texels_per_pixel = 4.0;
  const auto globe = globe_of(source, false, options);
  globe->set_camera(kNearView);
  std::vector<Drawn> one = drawn({&globe->main_view()});
  settle_all(*globe, one);
  auto further = view_of(*globe, kFarView);
  std::vector<Drawn> both = drawn({&globe->main_view(), further.get()});
  both[1].size = kMainView;
  both[1].target = std::make_unique<OffscreenTarget>(kMainView);
  settle_all(*globe, both);
  const int reads = source->reads();
  for (int k = 0; k < 10; ++k) {
    for (Drawn& each : both) {
      each.stats = each.view->render(each.target->framebuffer(), each.size);
      EXPECT_EQ(each.stats.tiles_pending, 0);
    }
  }
  EXPECT_EQ(source->reads(), reads);
  // The room is whole again once the other view is gone.
  ASSERT_LT(both[0].stats.tiles_wanted, one[0].stats.tiles_wanted) << "there was room for both: nothing was tested";
  const int wanted = one[0].stats.tiles_wanted;
  globe->render(both[0].target->framebuffer(), kMainView);
  both.pop_back();
  further.reset();
  settle_all(*globe, both);
  EXPECT_EQ(globe->render(both[0].target->framebuffer(), kMainView).tiles_wanted, wanted);
}

// A view that stands still is not drawn for tiles that only another view wants.
TEST_F(Views, OneThatStandsStillNeedsNoFramesWhileAnotherMoves) {
  const auto globe = globe_of(painted_land(), true);
  globe->set_camera(kOverView);
  const auto moving = view_of(*globe, kNearView);
  std::vector<Drawn> both = drawn({&globe->main_view(), moving.get()});
  settle_all(*globe, both);
  int still = 0, moves = 0;
  for (int k = 1; k <= 8; ++k) {
    moving->set_camera(camera_at(46, 7 + 3 * k, 3.0e5));
    EXPECT_FALSE(globe->needs_frame()) << "another view's camera";
    std::vector<Drawn> one = drawn({moving.get()});
    settle_all(*globe, one);
    moves += one.front().frames_to_settle;
    still += globe->needs_frame() ? 1 : 0;
    both.resize(1);
    settle_all(*globe, both);
  }
  EXPECT_GT(moves, 8);
  EXPECT_LE(still, 8);
  // All views draw the layers that they share.
  globe->set_unlit(true);
  EXPECT_TRUE(globe->needs_frame());
  EXPECT_TRUE(moving->needs_frame());
}

TEST_F(Views, PickAndCreditWhatTheyShow) {
  const auto globe = globe_of(painted_land());
  const LayerId land_id = globe->imagery().front();
  ASSERT_TRUE(globe->set_attribution(land_id, "land"));
  globe->set_camera(kNearView);
  const auto away = view_of(*globe, {.eye = {.lat = {}, .lon = {}, .height_m = 1e7}, .pitch = Angle::degrees(60)});
  std::vector<Drawn> both = drawn({&globe->main_view(), away.get()});
  settle_all(*globe, both);
  EXPECT_EQ(globe->attributions(), std::vector<std::string>{"land"});
  EXPECT_EQ(away->attributions(), std::vector<std::string>{}) << "looks beside the globe";
  EXPECT_TRUE(globe->pick({48, 48}, kMainView).place);
  EXPECT_FALSE(away->pick({24, 24}, kMapView).place);
  away->set_camera(kFarView);
  const auto place = away->pick({24, 24}, kMapView).place;
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->lon.deg(), -130.0, 1.0);
  const auto pixel = away->project(*place, kMapView);
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x, 24.0, 1e-3);
  EXPECT_FALSE(globe->project(*place, kMainView));
}

/// GL objects of each kind that there are.
std::map<std::string, int> objects_of_views() {
  std::map<std::string, int> there;
  for (GLuint name = 1; name < 5000; ++name) {
    there["buffers"] += glIsBuffer(name);
    there["framebuffers"] += glIsFramebuffer(name);
    there["textures"] += glIsTexture(name);
    there["vertex arrays"] += glIsVertexArray(name);
  }
  return there;
}

TEST_F(Views, AHundredPairsLeaveNothing) {
  const OffscreenTarget target(kMapView);
  const auto globe = globe_of(painted_land(), true);
  globe->render(target.framebuffer(), kMapView);
  const auto before = objects_of_views();
  for (int k = 0; k < 100; ++k) {
    const auto a = view_of(*globe, kNearView), b = view_of(*globe, kFarView);
    if (k % 10 != 0) continue;  // most of the time goes into the frames
    a->render(target.framebuffer(), kMapView);
    b->render(target.framebuffer(), kMapView);
  }
  // Tiles of the views may have come, which have no objects of their own.
  EXPECT_EQ(objects_of_views(), before);
  EXPECT_FALSE(has_leaked());
}

// A layer, the heights, and the globe itself may go while a view has drawn them.
TEST_F(Views, OutliveLayersAndTheGlobe) {
  const OffscreenTarget target(kMapView);
  auto globe = globe_of(painted_land(), true);
  const auto view = view_of(*globe, kNearView);
  view->render(target.framebuffer(), kMapView);
  ASSERT_TRUE(globe->set_elevation({}));
  view->render(target.framebuffer(), kMapView);
  ASSERT_TRUE(globe->remove(globe->imagery().front()));
  EXPECT_TRUE(view->needs_frame());
  EXPECT_TRUE(view->attributions().empty());
  EXPECT_EQ(view->render(target.framebuffer(), kMapView).tiles_wanted, 0);
  EXPECT_TRUE(view->settled());
  globe.reset();
  EXPECT_FALSE(view->settled());
  EXPECT_FALSE(view->needs_frame());
#ifdef NDEBUG
  EXPECT_FALSE(view->copy_depth(target.framebuffer()));
  EXPECT_EQ(view->render(target.framebuffer(), kMapView).patches, 0);
#else
  EXPECT_DEATH(view->render(target.framebuffer(), kMapView), "the view's globe is gone");
#endif
}

// A second window has a context that shares textures, but neither vertex arrays nor framebuffers: a clear refusal, even
// though that context has vertex arrays of the same names.
TEST_F(Views, InAnotherContextThatSharesTexturesAreRefused) {
  const auto globe = globe_of(painted_land());
  const auto view = view_of(*globe, kNearView);
  EGLDisplay display = eglGetCurrentDisplay();
  EGLContext own = eglGetCurrentContext();
  eglBindAPI(EGL_OPENGL_API);
  const EGLint wish[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  EGLContext second = eglCreateContext(display, EGL_NO_CONFIG_KHR, own, wish);
  ASSERT_NE(second, EGL_NO_CONTEXT);
  ASSERT_TRUE(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, second));
  GLuint arrays[100];
  glCreateVertexArrays(100, arrays);
#ifdef NDEBUG
  const Status refused = view->copy_depth(0);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("another OpenGL context is current"), std::string::npos);
  EXPECT_NE(refused.error().message.find("draw into a texture"), std::string::npos) << "no cure";
  view->render(0, kMapView);
  EXPECT_FALSE(view->status());
#else
  EXPECT_DEATH(view->render(0, kMapView), "another OpenGL context is current");
#endif
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, own);
  eglDestroyContext(display, second);
}

}  // namespace
}  // namespace terrella::test
