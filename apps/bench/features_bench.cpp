#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/sources/wave_numbers.h"
#include "apps/bench/value_of.h"
#include "apps/open_scene/sky_data.h"
#include "apps/process/data_dir.h"
#include "render/gl/offscreen.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::bench {
namespace {

constexpr Camera kFourRadii{
    .eye = {.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = 3.0 * 6378137.0}};
constexpr const char* kPlain = "plain: lit, no sky";
constexpr const char* kUnlit = "unlit";
constexpr const char* kSky = "sky and air";
constexpr const char* kWavePicture = "a picture of waves";

std::shared_ptr<TileSource> included_earth() { return value_of(open_tile_set(data_file("earth.gpkg").string())); }

GlobeOptions with_sky(bool time) {
  GlobeOptions options;
  SkyData data = load_sky_data();
  if (!data.problems.empty()) throw std::runtime_error(data.problems.front());
  options.sky = true;
  options.stars = std::move(data.stars);
  if (time) options.time = value_of(parse_utc("2026-06-21T12:00Z"));
  if (time) options.night_lights = std::move(data.night_lights);
  return options;
}

ObjectScene spheres(int count, double radius_m, double lowest_m, double highest_m) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> sine(-1.0, 1.0), lon(-180.0, 180.0), height(lowest_m, highest_m);
  ObjectScene scene;
  for (int k = 0; k < count; ++k) {
    const Geodetic place{
        .lat = Angle::radians(std::asin(sine(random))), .lon = Angle::degrees(lon(random)), .height_m = height(random)};
    scene.points.push_back({.place = place, .radius_m = radius_m});
  }
  return scene;
}

/// Frames of globes with one feature each, on one target. `base`: the name of the frame that a ratio is taken to.
class FeatureFrames {
 public:
  explicit FeatureFrames(const BenchOptions& options)
      : options_(options),
        quick_(options.effort == Effort::quick),
        size_(quick_ ? Viewport{192, 192} : Viewport{1024, 1024}),
        target_(size_) {}

  /// Adds a frame unless --only leaves it out; returns the globe that it draws.
  Globe* add(const std::string& name, const std::string& base, GlobeOptions options,
             std::shared_ptr<TileSource> imagery = included_earth(), const ImageLook& look = {}) {
    if (!options_.wants(name) && name != kPlain && name != kUnlit && name != kWavePicture) return nullptr;
    options_.progress(name);
    options.upload_bytes_per_frame = options.gpu_bytes;
    options.upload_time_per_frame = std::chrono::seconds(1);
    globes_.push_back(value_of(Globe::create(options)));
    Globe& globe = *globes_.back();
    static_cast<void>(value_of(globe.add_imagery(std::move(imagery), look)));
    globe.set_camera(kFourRadii);
    subjects_.push_back({name, [this, &globe] { globe.render(target_.framebuffer(), size_); }});
    bases_.push_back(base);
    return &globe;
  }
  /// The eye of the frame added last moves to and fro, so that the air is new in each frame.
  void move_eye() {
    subjects_.back().draw = [this, &globe = *globes_.back(), far = false]() mutable {
      Camera camera = kFourRadii;
      far = !far;
      if (far) camera.eye.height_m *= 1.01;
      globe.set_camera(camera);
      globe.render(target_.framebuffer(), size_);
    };
  }
  void measure() {
    for (const auto& globe : globes_) {
      const auto late = std::chrono::steady_clock::now() + std::chrono::minutes(2);
      if (!globe->render_until_settled(target_.framebuffer(), size_, late)) {
        throw std::runtime_error("a globe has not settled in two minutes");
      }
    }
    time_frames(subjects_, quick_ ? 2 : 15);
  }
  [[nodiscard]] const Subject& subject(const std::string& name) const {
    return *std::ranges::find(subjects_, name, &Subject::name);
  }
  void add_rows(Report& report) const {
    for (std::size_t k = 0; k < subjects_.size(); ++k) {
      const Subject &s = subjects_[k], &base = subject(bases_[k]);
      report.rows.push_back({s.name, base.name, median(s.cpu_ms), median(s.ms), median_ratio(s.cpu_ms, base.cpu_ms),
                             median_ratio(s.ms, base.ms), median_ratio(s.cpu_ms, subject(kUnlit).cpu_ms),
                             static_cast<double>(globes_[k]->last_frame().gpu_bytes) / (1 << 20)});
    }
  }

 private:
  const BenchOptions& options_;
  bool quick_;
  Viewport size_;
  OffscreenTarget target_;
  std::vector<std::unique_ptr<Globe>> globes_;
  std::vector<Subject> subjects_;
  std::vector<std::string> bases_;
};

void add_looks(FeatureFrames& frames) {
  const auto add = [&](const char* name, const SurfaceLook& surface, Stereo stereo) {
    frames.add(name, kPlain, {.surface = surface, .stereo = {.mode = stereo}});
  };
  const SurfaceLook opaque, glass{.alpha = 0.5};
  add(kPlain, opaque, Stereo::off);
  add("the same again", opaque, Stereo::off);
  frames.add(kUnlit, kPlain, {.unlit = true});
  add("translucent", glass, Stereo::off);
  add("stereo, side by side", opaque, Stereo::side_by_side);
  add("stereo, interlaced", opaque, Stereo::interlaced);
  add("stereo, anaglyph", opaque, Stereo::anaglyph);
  add("translucent, interlaced", glass, Stereo::interlaced);
  add("bilinear magnification", {.sharpness = Sharpness::bilinear}, Stereo::off);
  if (Globe* globe = frames.add("two layers", kPlain, {})) {
    static_cast<void>(value_of(globe->add_imagery(included_earth(), {.opacity = 0.5})));
  }
}

void add_skies(FeatureFrames& frames) {
  if (Globe* globe = frames.add("sky there but off", kPlain, with_sky(false))) globe->set_sky(false);
  frames.add(kSky, kPlain, with_sky(false));
  GlobeOptions starless = with_sky(false);
  starless.stars.clear();
  frames.add("sky without stars", kPlain, std::move(starless));
  if (frames.add("sky, moving", kPlain, with_sky(false)) != nullptr) frames.move_eye();
  frames.add("sky, Sun, Moon, city lights", kPlain, with_sky(true));
  GlobeOptions dull = with_sky(true);
  dull.surface.glint = false;
  frames.add("the same without glint", kPlain, std::move(dull));
}

void add_relief(FeatureFrames& frames) {
  const auto add = [&](const char* name, const GlobeOptions& options) {
    Globe* globe = frames.add(name, kPlain, options);
    if (globe == nullptr) return;
    const auto heights = wave_numbers(-6375.0, 50.0, {.floats = true, .unit = "m"});
    const Status set = globe->set_elevation(value_of(ElevationSource::open(heights, "waves")));
    if (!set) throw std::runtime_error(set.error().message);
  };
  add("relief", {});
  add("relief, unlit", {.unlit = true});
  add("relief, hillshade", {.surface = {.hillshade = true}});
}

void add_spheres(FeatureFrames& frames, bool quick) {
  const int count = quick ? 1000 : 100'000;
  const auto add = [&](double km, bool over) {
    Globe* globe = frames.add(fmt::format("{} spheres of {} km {} it", count, km, over ? "over" : "under"), kPlain, {});
    if (globe == nullptr) return;
    static_cast<void>(value_of(globe->add_objects(spheres(count, 1e3 * km, over ? 1e3 : -7e5, over ? 7e5 : -1e3))));
  };
  for (const double km : {5.0, 20.0, 40.0}) add(km, true);
  add(5.0, false);
}

void add_numbers(FeatureFrames& frames) {
  ImageLook look;
  look.numbers = NumberLook{.low = 0.0, .high = 255.0, .colors = *named_color_map("viridis")};
  frames.add(kWavePicture, kWavePicture, {}, wave_pictures());
  frames.add("numbers of 16 bits", kWavePicture, {},
             wave_numbers(0.0, 1.0, {.floats = true, .whole = WholeRange{0, 255}}), look);
  frames.add("numbers of 32-bit floats", kWavePicture, {}, wave_numbers(0.0, 1.0, {.floats = true}), look);
}

Report measure_features(const BenchOptions& options) {
  Report report{.name = "features",
                .title = "Frames with one feature each, as ratios to the plain globe",
                .facts = {{"renderer", renderer_name()},
                          {"time", timing_method()},
                          {"picture", "the included Earth from four radii; relief and numbers are painted waves"}},
                .columns = {{"frame", ""},
                            {"base", ""},
                            {"cpu", "ms of processor", 1},
                            {"time", "ms", 1},
                            {"cpu_ratio", "of the base"},
                            {"time_ratio", "of the base"},
                            {"cpu_over_unlit", "of an unlit frame"},
                            {"slots", "MiB", 1}}};
  FeatureFrames frames(options);
  add_looks(frames);
  add_skies(frames);
  add_relief(frames);
  add_spheres(frames, options.effort == Effort::quick);
  add_numbers(frames);
  frames.measure();
  frames.add_rows(report);
  if (options.wants(kSky)) {
    report.findings = {{"the default picture of `view`, to an unlit one",
                        median_ratio(frames.subject(kSky).whole_ms, frames.subject(kUnlit).whole_ms),
                        options.effort == Effort::quick ? kNoFigure : 1.35}};
  }
  report.plots = {{.title = "cost of features", .x = "time", .y = "cpu_ratio", .series = "frame", .lines = false}};
  return report;
}

}  // namespace

Result<Report> bench_features(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  try {
    return measure_features(options);
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace terrella::bench
