// Errors for misuse of the Globe API. None of it may crash if assertions are off.
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kMisused{32, 32};
const TileGrid kSmallGrid{.tile_px = 16, .max_level = 1};

/// A context without a surface of another API or version than the fixture's.
class OtherContext {
 public:
  explicit OtherContext(EGLenum api)
      : display_(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr)) {
    eglInitialize(display_, nullptr, nullptr);
    eglBindAPI(api);
    const EGLint wish[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wish);
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }
  ~OtherContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglBindAPI(EGL_OPENGL_API);
  }
  OtherContext(const OtherContext&) = delete;
  OtherContext& operator=(const OtherContext&) = delete;
  [[nodiscard]] bool made() const { return context_ != EGL_NO_CONTEXT; }

 private:
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

/// Nothing is current as long as it lives.
class NoContext {
 public:
  NoContext() : display_(eglGetCurrentDisplay()), context_(eglGetCurrentContext()) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  ~NoContext() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }
  NoContext(const NoContext&) = delete;
  NoContext& operator=(const NoContext&) = delete;

 private:
  EGLDisplay display_;
  EGLContext context_;
};

/// Answers every question with what it was given.
class OneAnswer : public TileSource {
 public:
  explicit OneAnswer(Result<EncodedTile, TileFailure> answer, const TileGrid& grid = kSmallGrid)
      : answer_(std::move(answer)) {
    info_.grid = grid;
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId&) override { return answer_; }

 private:
  TileSetInfo info_;
  Result<EncodedTile, TileFailure> answer_;
};

/// Has all of its tiles elsewhere, and who is asked for them never answers.
class NeverAnswers : public OneAnswer, public RemoteTiles {
 public:
  NeverAnswers() : OneAnswer(TileFailure{MissingKind::remote, "elsewhere"}) {}
  [[nodiscard]] RemoteTiles* remote() override { return this; }
  void fetch(const TileId&, double, Done) override {}
  void set_priority(const TileId&, double) override {}
  void cancel(const TileId&) override {}
};

std::string message_of(const auto& result) { return result ? "no error" : result.error().message; }

#ifdef NDEBUG
// Assertions are off: an error, or nothing done.
#define EXPECT_TOLD(call, name) EXPECT_NE(message_of(call).find(name), std::string::npos)
#define EXPECT_IGNORED(call, name) call
#else
#define EXPECT_TOLD(call, name) EXPECT_DEATH(static_cast<void>(call), name)
#define EXPECT_IGNORED(call, name) EXPECT_DEATH(call, name)
#endif

class Misuse : public GlTest {
 protected:
  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "fast");
    GlTest::SetUp();
  }
  static std::shared_ptr<TileSource> green() { return one_colour(kSmallGrid, {0, 200, 0}); }
};

TEST(MisuseWithoutContext, CreatingWithoutOneIsAnError) {
  const auto globe = Globe::create(GlobeOptions{});
  ASSERT_FALSE(globe);
  EXPECT_NE(globe.error().message.find("no OpenGL context is current"), std::string::npos) << globe.error().message;
}

TEST(MisuseWithoutContext, CreatingInOneOfAnotherKindIsAnError) {
  const OtherContext embedded(EGL_OPENGL_ES_API);
  ASSERT_TRUE(embedded.made());
  const auto globe = Globe::create(GlobeOptions{});
  ASSERT_FALSE(globe);
  EXPECT_NE(globe.error().message.find("OpenGL ES"), std::string::npos) << globe.error().message;
  EXPECT_NE(globe.error().message.find("needs OpenGL 4.5"), std::string::npos) << globe.error().message;
}

[[noreturn]] void create_in_an_older_context() {
  setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
  const OtherContext old(EGL_OPENGL_API);
  const auto globe = Globe::create(GlobeOptions{});
  if (!globe) std::fprintf(stderr, "%s\n", globe.error().message.c_str());
  std::exit(old.made() && !globe ? 0 : 1);
}

// In a process of its own: Mesa asks once which version to be.
TEST(MisuseWithoutContext, CreatingInAnOlderOneIsAnError) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(create_in_an_older_context(), testing::ExitedWithCode(0), "is OpenGL 3.3; the globe needs OpenGL 4.5");
}

TEST_F(Misuse, ALayerThatIsNotThereIsAnErrorThatNamesTheCall) {
  const auto globe = make_globe({}, green());
  const LayerId imagery = globe->imagery().front(), objects = *globe->add_objects({});
  ASSERT_TRUE(globe->remove(imagery));
  ASSERT_TRUE(globe->remove(objects));
  for (const LayerId gone : {imagery, objects, LayerId::none}) {
    EXPECT_NE(message_of(globe->remove(gone)).find("Globe::remove"), std::string::npos);
    EXPECT_NE(message_of(globe->move(gone, 0)).find("Globe::move"), std::string::npos);
    EXPECT_NE(message_of(globe->set_look(gone, {})).find("Globe::set_look"), std::string::npos);
    EXPECT_NE(message_of(globe->look(gone)).find("Globe::look"), std::string::npos);
    EXPECT_NE(message_of(globe->set_objects(gone, {})).find("Globe::set_objects"), std::string::npos);
    EXPECT_NE(message_of(globe->show_objects(gone, true)).find("Globe::show_objects"), std::string::npos);
    EXPECT_NE(message_of(globe->fade_objects(gone, 0.5)).find("Globe::fade_objects"), std::string::npos);
  }
  draw(*globe, kMisused);
}

TEST_F(Misuse, ASourceThatCannotBeIsAnError) {
  const auto globe = make_globe({}, green());
  EXPECT_NE(message_of(globe->add_imagery(nullptr)).find("Globe::add_imagery"), std::string::npos);
  EXPECT_FALSE(Globe::create(GlobeOptions{}, nullptr));
  const TileFailure nothing{MissingKind::absent, "nothing"};
  for (const TileGrid& grid : {TileGrid{.tile_px = 0}, TileGrid{.root_span_deg = 0.0}, TileGrid{.max_level = 99},
                               TileGrid{.min_level = 3, .max_level = 2}, TileGrid{.min_level = -1}}) {
    const auto added = globe->add_imagery(std::make_shared<OneAnswer>(nothing, grid));
    EXPECT_NE(message_of(added).find("Globe::add_imagery"), std::string::npos);
  }
  for (const double opacity : {-0.1, 1.1, std::nan("")}) {
    EXPECT_FALSE(globe->add_imagery(green(), {.opacity = opacity}));
    EXPECT_FALSE(globe->set_look(globe->imagery().front(), {.opacity = opacity}));
  }
  EXPECT_EQ(globe->imagery().size(), 1U);
}

TEST_F(Misuse, ASourceThatAnswersNothingLeavesThePlainColour) {
  for (const MissingKind kind : {MissingKind::absent, MissingKind::blank, MissingKind::broken, MissingKind::failed}) {
    const auto globe = make_globe(unlit_options(), std::make_shared<OneAnswer>(TileFailure{kind, "nothing"}));
    globe->set_camera(camera_at(0, 0, 1.0e6));
    settle(*globe, kMisused);
    EXPECT_EQ(picture().at(16, 16), (Color{30, 38, 52}));
    ASSERT_FALSE(globe->missing_tiles().empty());
    EXPECT_EQ(globe->missing_tiles().back().layer, globe->imagery().front());
  }
  const auto globe = make_globe(unlit_options(), std::make_shared<OneAnswer>(EncodedTile{}));
  settle(*globe, kMisused);
  EXPECT_FALSE(globe->missing_tiles().empty());
}

TEST_F(Misuse, ASourceThatNeverAnswersIsWaitedForNoLongerThanTheDeadline) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kPatience{200};
  const OffscreenTarget target(kMisused);
  auto globe = make_globe(unlit_options(), std::make_shared<NeverAnswers>());
  globe->set_camera(camera_at(0, 0, 1.0e6));
  const auto start = Clock::now();
  EXPECT_FALSE(globe->render_until_settled(target.framebuffer(), kMisused, start + kPatience));
  EXPECT_GE(Clock::now() - start, kPatience);
  EXPECT_GT(globe->loading().fetching, 0U);
  EXPECT_GT(globe->render(target.framebuffer(), kMisused).tiles_pending, 0);
  globe.reset();
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(20));
}

TEST_F(Misuse, AnotherThreadIsTold) {
  const auto globe = make_globe({}, green());
  const LayerId first = globe->imagery().front();
  const OffscreenTarget target(kMisused);
  const auto elsewhere = [](auto call) {
    std::thread thread(call);
    thread.join();
  };
  const auto told = [&](auto call) {
    Status status = Done{};
    elsewhere([&] {
      const auto result = call();
      if (!result) status = result.error();
    });
    return status;
  };
  EXPECT_TOLD(told([&] { return globe->add_imagery(green()); }), "Globe::add_imagery");
  EXPECT_TOLD(told([&] { return globe->remove(first); }), "Globe::remove");
  EXPECT_TOLD(told([&] { return globe->set_time({}); }), "Globe::set_time");
  EXPECT_TOLD(told([&] { return globe->set_elevation({}); }), "Globe::set_elevation");
  const Camera before = globe->camera();
  EXPECT_IGNORED(elsewhere([&] { globe->set_camera(camera_at(1, 2, 3)); }), "Globe::set_camera");
  EXPECT_EQ(globe->camera().eye.height_m, before.eye.height_m);
  FrameStats stats;
  EXPECT_IGNORED(elsewhere([&] { stats = globe->render(target.framebuffer(), kMisused); }), "Globe::render");
  EXPECT_EQ(stats.patches, 0);
  EXPECT_GT(globe->render(target.framebuffer(), kMisused).patches, 0);
}

TEST_F(Misuse, WithoutItsContextAGlobeDrawsNothingAndEndsQuietly) {
  auto globe = make_globe({}, green());
  draw(*globe, kMisused);
  const NoContext none;
  EXPECT_TOLD(globe->add_imagery(green()), "Globe::add_imagery");
  FrameStats stats;
  EXPECT_IGNORED(stats = globe->render(0, kMisused), "Globe::render");
  EXPECT_EQ(stats.patches, 0);
  globe.reset();
}

TEST_F(Misuse, InAnotherContextAGlobeDrawsNothing) {
  const auto globe = make_globe({}, green());
  draw(*globe, kMisused);
  const NoContext back_at_the_end;
  const OtherContext other(EGL_OPENGL_API);
  ASSERT_TRUE(other.made());
  EXPECT_TOLD(globe->add_imagery(green()), "Globe::add_imagery");
}

}  // namespace
}  // namespace terrella::test
