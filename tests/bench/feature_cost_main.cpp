// Cost of each feature: a frame with it as a ratio to the plain opaque globe, and to imagery alone, all in turn in
// one run.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/bench/frame_timing.h"
#include "apps/setup/sky_data.h"
#include "render/gl/offscreen.h"
#include "streaming/sets/open_tile_set.h"

#include <epoxy/gl.h>

namespace {

using namespace terrella;
using bench::median;
using bench::Subject;
using Clock = std::chrono::steady_clock;

constexpr Viewport kSize{1024, 1024};
constexpr double kHeight_m = 3.0 * 6378137.0;

struct Inputs {
  std::string tiles, elevation;
  Camera camera;
};

template <class T>
T value_or_throw(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

std::unique_ptr<Globe> make_globe(const Inputs& inputs, GlobeOptions options, bool relief) {
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  std::optional<ElevationSource> heights;
  if (relief) {
    heights = value_or_throw(
        ElevationSource::open(std::shared_ptr<TileSource>(value_or_throw(open_tile_set(inputs.elevation))), "heights"));
  }
  auto globe = value_or_throw(Globe::create(
      options, std::shared_ptr<TileSource>(value_or_throw(open_tile_set(inputs.tiles))), std::move(heights)));
  globe->set_camera(inputs.camera);
  return globe;
}

GlobeOptions with_sky(bool time) {
  GlobeOptions options;
  SkyData data = load_sky_data();
  if (!data.problems.empty()) throw std::runtime_error(data.problems.front());
  options.sky = true;
  options.stars = std::move(data.stars);
  if (time) options.time = value_or_throw(parse_utc("2026-06-21T12:00Z"));
  if (time) options.night_lights = std::move(data.night_lights);
  return options;
}

GlobeOptions unlit() {
  GlobeOptions options;
  options.unlit = true;
  return options;
}

/// Globes and what is drawn of them; all on one target.
class Features {
 public:
  /// `only`: the names of the subjects that are measured; empty: all of them.
  explicit Features(std::vector<std::string> only) : only_(std::move(only)) {
    if (!only_.empty()) only_.insert(only_.end(), {"plain opaque globe", "unlit"});
  }
  /// A frame of a new globe.
  void add(const std::string& name, std::unique_ptr<Globe> globe) {
    if (!only_.empty() && std::ranges::find(only_, name) == only_.end()) return;
    globes_.push_back(std::move(globe));
    Globe& added = *globes_.back();
    if (!added.render_until_settled(target_.framebuffer(), kSize, Clock::now() + std::chrono::seconds(60))) {
      throw std::runtime_error("the globe has not settled after a minute");
    }
    subjects_.push_back({name, [this, &added] { added.render(target_.framebuffer(), kSize); }});
  }
  /// A frame of a new globe whose eye has come nearer or gone away since the frame before, so that the air is new.
  void add_moving(const std::string& name, std::unique_ptr<Globe> globe) {
    constexpr double kStep = 1.01;
    Camera camera = globe->camera();
    const std::size_t before = subjects_.size();
    add(name, std::move(globe));
    if (subjects_.size() == before) return;
    subjects_.back().draw = [this, &moving = *globes_.back(), camera, far = false]() mutable {
      far = !far;
      camera.eye.height_m *= far ? kStep : 1.0 / kStep;
      moving.set_camera(camera);
      moving.render(target_.framebuffer(), kSize);
    };
  }
  std::vector<Subject>& subjects() { return subjects_; }
  [[nodiscard]] const Subject& subject(const std::string& name) const {
    return *std::ranges::find(subjects_, name, &Subject::name);
  }

 private:
  std::vector<std::string> only_;
  OffscreenTarget target_{kSize};
  std::vector<std::unique_ptr<Globe>> globes_;
  std::vector<Subject> subjects_;
};

void add_all(const Inputs& inputs, Features& features) {
  const auto add = [&](const std::string& name, const SurfaceLook& surface, Stereo stereo) {
    GlobeOptions options;
    options.surface = surface;
    options.stereo.mode = stereo;
    features.add(name, make_globe(inputs, std::move(options), false));
  };
  const SurfaceLook opaque, glass{.alpha = 0.5};
  add("plain opaque globe", opaque, Stereo::off);
  add("the same again", opaque, Stereo::off);
  auto switched_off = make_globe(inputs, with_sky(false), false);
  switched_off->set_sky(false);
  features.add("sky there but off", std::move(switched_off));
  add("translucent", glass, Stereo::off);
  add("stereo, side by side", opaque, Stereo::side_by_side);
  add("stereo, interlaced", opaque, Stereo::interlaced);
  add("stereo, anaglyph", opaque, Stereo::anaglyph);
  add("translucent, interlaced", glass, Stereo::interlaced);
  auto two_layers = make_globe(inputs, {}, false);
  value_or_throw(two_layers->add_imagery(value_or_throw(open_tile_set(inputs.tiles)), {.opacity = 0.5}));
  features.add("two layers", std::move(two_layers));
  add("bilinear magnification", {.sharpness = Sharpness::bilinear}, Stereo::off);
  features.add("unlit", make_globe(inputs, unlit(), false));
  features.add("sky", make_globe(inputs, with_sky(false), false));
  GlobeOptions starless = with_sky(false);
  starless.stars.clear();
  features.add("sky without stars", make_globe(inputs, std::move(starless), false));
  features.add_moving("unlit, moving", make_globe(inputs, unlit(), false));
  features.add_moving("sky, moving", make_globe(inputs, with_sky(false), false));
  features.add("sky, Sun, Moon, city lights", make_globe(inputs, with_sky(true), false));
  GlobeOptions dull = with_sky(true);
  dull.surface.glint = false;
  features.add("the same without glint", make_globe(inputs, std::move(dull), false));
  if (inputs.elevation.empty()) return;
  features.add("relief", make_globe(inputs, {}, true));
  features.add("relief, unlit", make_globe(inputs, unlit(), true));
  features.add("relief, hillshade", make_globe(inputs, {.surface = {.hillshade = true}}, true));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Cost of each feature as a ratio to the plain opaque globe, in one run");
  Inputs inputs;
  std::string camera;
  int rounds = 15;
  std::vector<std::string> only;
  app.add_option("--tiles", inputs.tiles, "tile set for the globe")->required();
  app.add_option("--elevation", inputs.elevation, "tile set of heights; none: relief is not measured");
  app.add_option("--camera", camera, "LAT,LON,ALT[,HEADING[,PITCH[,FOV]]] (default: four radii, over 10 N 20 E)");
  app.add_option("--rounds", rounds, "frames of each subject");
  app.add_option("--only", only,
                 "the named frames alone, in place of all; \"plain opaque globe\" and \"unlit\" come along");
  CLI11_PARSE(app, argc, argv);
  try {
    inputs.camera.eye = {.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = kHeight_m};
    if (!camera.empty()) inputs.camera = value_or_throw(parse_camera(camera));
    const auto context = value_or_throw(HeadlessContext::create());
    fmt::print("{}\n\n| frame | processor | wall | processor, to unlit |\n|---|---|---|---|\n",
               reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
    Features features(std::move(only));
    add_all(inputs, features);
    bench::time_frames(features.subjects(), rounds);
    const Subject& base = features.subjects().front();
    for (const Subject& s : features.subjects()) {
      fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} |\n", s.name, bench::median_ratio(s.cpu_ms, base.cpu_ms),
                 bench::median_ratio(s.ms, base.ms), bench::median_ratio(s.cpu_ms, features.subject("unlit").cpu_ms));
    }
    fmt::print("\nplain opaque globe: {:.1f} ms of processor time, {:.1f} ms\n", median(base.cpu_ms), median(base.ms));
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "{}\n", wrong.what());
    return 1;
  }
  return 0;
}
