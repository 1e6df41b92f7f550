// The contract of threads: each call of Globe and GlobeView notices that it comes from another thread than the globe's.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <functional>
#include <future>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/gl/painted_numbers.h"

namespace terrella::test {
namespace {

constexpr Viewport kThreadPicture{32, 32};
constexpr glm::dvec2 kThreadPixel{16.0, 16.0};
const TileGrid kThreadGrid{.tile_px = 16, .max_level = 1};
const Geodetic kThreadPlace{.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = 0.0};

/// A call, and what it returns in words: "" for nothing, false and 0, else a value or an error.
struct Call {
  std::string name;
  std::function<std::string()> words;
};

std::string words_of(bool value) { return value ? "true" : ""; }
template <class T>
std::string words_of(const Result<T>& result) {
  return result ? "done" : result.error().message;
}
template <class T>
std::string words_of(const std::optional<T>& value) {
  return value ? "a value" : "";
}

/// The calls that both classes have. The globe has been drawn, and its camera is not the default one.
template <class Of>
std::vector<Call> shared_calls(const std::string& of, Of& globe, unsigned target) {
  const auto call = [of](const char* name, std::function<std::string()> words) {
    return Call{of + "::" + name, std::move(words)};
  };
  return {call("camera", [&globe] { return words_of(globe.camera() != Camera{}); }),
          call("last_frame", [&globe, target] { return words_of(globe.last_frame().patches > 0); }),
          call("status", [&globe, target] { return words_of(globe.status()); }),
          call("depth_texture", [&globe, target] { return words_of(globe.depth_texture() != 0); }),
          call("copy_depth", [&globe, target] { return words_of(globe.copy_depth(target)); }),
          call("settled", [&globe, target] { return words_of(globe.settled()); }),
          call("needs_frame",
               [&globe, target] {
                 return words_of(globe.needs_frame(0, {1, 1}));
               }),
          call("attributions", [&globe, target] { return words_of(!globe.attributions().empty()); }),
          call("finest_texel_m", [&globe, target] { return words_of(globe.finest_texel_m()); }),
          call("pick", [&globe, target] { return words_of(globe.pick(kThreadPixel, kThreadPicture).place); }),
          call("project", [&globe, target] { return words_of(globe.project(kThreadPlace, kThreadPicture)); }),
          call("view", [&globe, target] { return words_of(globe.view(kThreadPicture).viewport == kThreadPicture); }),
          call("render", [&globe, target] { return words_of(globe.render(target, kThreadPicture).patches > 0); }),
          call("render_until_settled", [&globe, target] {
            return words_of(globe.render_until_settled(target, kThreadPicture,
                                                       std::chrono::steady_clock::now() + std::chrono::minutes(1)));
          })};
}

/// The calls of a globe that return something. The first image layer is one of numbers.
std::vector<Call> globe_calls(Globe& globe, LayerId image, LayerId objects) {
  ImageLook look;
  look.numbers = NumberLook{};
  return {
      {"Globe::options", [&globe] { return words_of(globe.options().unlit); }},
      {"Globe::imagery", [&globe] { return words_of(!globe.imagery().empty()); }},
      {"Globe::objects", [&globe] { return words_of(!globe.objects().empty()); }},
      {"Globe::has_relief", [&globe] { return words_of(globe.has_relief()); }},
      {"Globe::loading", [&globe] { return words_of(globe.loading().read > 0); }},
      {"Globe::missing_tiles", [&globe] { return words_of(!globe.missing_tiles().empty()); }},
      {"Globe::value_at", [&globe, image] { return words_of(globe.value_at(image, kThreadPlace)); }},
      {"Globe::stored_value", [&globe, image] { return words_of(globe.stored_value(image, kThreadPlace).get().ok()); }},
      {"Globe::ground", [&globe] { return words_of(globe.ground().has_relief()); }},
      {"Globe::ground_height_m",
       [&globe] { return words_of(globe.ground_height_m(kThreadPlace.lat, kThreadPlace.lon) != 0.0); }},
      {"Globe::elevation_m", [&globe] { return words_of(globe.elevation_m(kThreadPlace.lat, kThreadPlace.lon)); }},
      {"Globe::look", [&globe, image] { return words_of(globe.look(image)); }},
      {"Globe::set_look", [&globe, image, look] { return words_of(globe.set_look(image, look)); }},
      {"Globe::move", [&globe, image] { return words_of(globe.move(image, 0)); }},
      {"Globe::invalidate", [&globe, image] { return words_of(globe.invalidate(image)); }},
      {"Globe::set_attribution", [&globe, image] { return words_of(globe.set_attribution(image, "us")); }},
      {"Globe::attribution", [&globe, image] { return words_of(globe.attribution(image)); }},
      {"Globe::set_objects",
       [&globe, objects] { return words_of(globe.set_objects(objects, {.points = {{.place = kThreadPlace}}})); }},
      {"Globe::edit_objects", [&globe, objects] { return words_of(globe.edit_objects(objects, {})); }},
      {"Globe::show_objects", [&globe, objects] { return words_of(globe.show_objects(objects, true)); }},
      {"Globe::fade_objects", [&globe, objects] { return words_of(globe.fade_objects(objects, 1.0)); }},
      {"Globe::add_objects", [&globe] { return words_of(globe.add_objects({})); }},
      {"Globe::set_time", [&globe] { return words_of(globe.set_time({})); }},
      {"Globe::set_night_lights", [&globe] { return words_of(globe.set_night_lights(false)); }},
      {"GlobeView::create", [&globe] { return words_of(GlobeView::create(globe)); }}};
}

std::string on_another_thread(const std::function<std::string()>& words) {
  return std::async(std::launch::async, words).get();
}

/// On another thread a call returns nothing or an error that names it, or dies in a build with assertions. Here it
/// returns something, so the difference is seen.
void expect_told(const std::vector<Call>& calls) {
  for (const Call& call : calls) {
    const std::string told = call.name + ": called from another thread";
#ifdef NDEBUG
    const std::string words = on_another_thread(call.words);
    EXPECT_TRUE(words.empty() || words.rfind(told, 0) == 0) << call.name << ": " << words;
#else
    EXPECT_DEATH(on_another_thread(call.words), told);
#endif
    const std::string here = call.words();
    EXPECT_TRUE(here == "true" || here == "done" || here == "a value")
        << call.name << " on the globe's thread: " << here;
  }
}

/// A framebuffer with colours and depth.
struct DepthTarget {
  DepthTarget() {
    glTextureStorage2D(color.name(), 1, GL_RGBA8, kThreadPicture.width_px, kThreadPicture.height_px);
    glTextureStorage2D(depth.name(), 1, GL_DEPTH_COMPONENT32F, kThreadPicture.width_px, kThreadPicture.height_px);
    glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
    glNamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
  }
  gl::Texture color = gl::make_texture(GL_TEXTURE_2D), depth = gl::make_texture(GL_TEXTURE_2D);
  gl::Framebuffer framebuffer = gl::make_framebuffer();
};

class Threads : public GlTest {
 protected:
  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "fast");
    GlTest::SetUp();
    const auto heights =
        ElevationSource::open(painted_heights(kThreadGrid, [](double, double) { return 1000.0; }), "heights");
    ASSERT_TRUE(heights);
    globe_ = std::move(*Globe::create(unlit_options(),
                                      std::make_shared<PaintedSource>(
                                          kThreadGrid,
                                          [](double, double) {
                                            return Color{1, 2, 3};
                                          },
                                          [](const TileId& id) { return id.level == 1; }),
                                      *heights));
    ImageLook look;
    look.numbers = NumberLook{};
    numbers_ =
        *globe_->add_imagery(std::make_shared<PaintedNumbers>(kThreadGrid, [](double, double) { return 0.5F; }), look);
    objects_ = *globe_->add_objects({.points = {{.place = kThreadPlace}}});
    ASSERT_TRUE(globe_->set_attribution(numbers_, "us"));
    target_.emplace();
  }
  void TearDown() override {
    globe_.reset();
    target_.reset();
    GlTest::TearDown();
  }
  [[nodiscard]] bool settle(auto& view) const {
    view.set_camera({.eye = {.lat = kThreadPlace.lat, .lon = kThreadPlace.lon, .height_m = 5e6}});
    return view.render_until_settled(target_->framebuffer.name(), kThreadPicture,
                                     std::chrono::steady_clock::now() + std::chrono::minutes(1));
  }

  LayerId numbers_{}, objects_{};
  std::unique_ptr<Globe> globe_;
  std::optional<DepthTarget> target_;
};

TEST_F(Threads, OfAGlobe) {
  ASSERT_TRUE(settle(*globe_));
  expect_told(shared_calls("Globe", *globe_, target_->framebuffer.name()));
  expect_told(globe_calls(*globe_, numbers_, objects_));
}

TEST_F(Threads, OfAView) {
  const auto view = std::move(*GlobeView::create(*globe_));
  ASSERT_TRUE(settle(*view));
  expect_told(shared_calls("GlobeView", *view, target_->framebuffer.name()));
}

TEST_F(Threads, OfCallbacks) {
  int settled = 0, drawn = 0;
  const auto set = [&] {
    globe_->on_settled([&settled] { ++settled; });
    globe_->on_draw([&drawn](DrawStage, const FrameMatrices&) { ++drawn; });
    return std::string();
  };
#ifdef NDEBUG
  on_another_thread(set);
#else
  EXPECT_DEATH(on_another_thread(set), "Globe::on_settled: called from another thread");
#endif
  ASSERT_TRUE(settle(*globe_));
  EXPECT_EQ(settled + drawn, 0);
}

}  // namespace
}  // namespace terrella::test
