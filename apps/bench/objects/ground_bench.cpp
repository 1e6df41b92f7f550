#include "apps/bench/objects/ground_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/frame_timing.h"
#include "apps/bench/sources/wave_numbers.h"
#include "apps/bench/value_of.h"
#include "apps/process/data_dir.h"
#include "render/gl/offscreen.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// `count` areas that do not overlap, with 40 corners each, whatever their number, on ground or draped over it.
ObjectScene districts(int count, HeightMode heights, const Geodetic& middle, double span_deg) {
  constexpr int kSide = 10;
  const int across = static_cast<int>(std::lround(std::sqrt(double(count))));
  const auto at = [&](double column, double row) {
    const double sway = 0.15 * std::sin(2.1 * column + 3.3 * row);
    const double part_x = (column + sway) / across - 0.5, part_y = (row - sway) / across - 0.5;
    return Geodetic{middle.lat + Angle::degrees(span_deg * part_y),
                    middle.lon + Angle::degrees(2.0 * span_deg * part_x)};
  };
  ObjectScene scene;
  for (int k = 0; k < across * across; ++k) {
    const int x = k % across, y = k / across;
    PolygonObject area{.rings = {{}},
                       .fill = {std::uint8_t(k * 37), std::uint8_t(k * 91), 90, 140},
                       .stroke_width_px = 1.5F,
                       .of = {.id = ObjectId{std::uint64_t(k) + 1}},
                       .heights = heights};
    for (int side = 0; side < 4; ++side) {
      for (int step = 0; step < kSide; ++step) {
        const double t = double(step) / kSide;
        const double dx[] = {t, 1.0, 1.0 - t, 0.0}, dy[] = {0.0, t, 1.0, 1.0 - t};
        area.rings[0].push_back(at(x + dx[side], y + dy[side]));
      }
    }
    scene.polygons.push_back(std::move(area));
  }
  return scene;
}

ObjectScene long_track(HeightMode heights) {
  constexpr int kTrackPlaces = 200'000;
  LineObject line{.heights = heights};
  for (int k = 0; k < kTrackPlaces; ++k) {
    const double t = double(k) / kTrackPlaces - 0.5;
    line.places.push_back({Angle::degrees(10.0 + 40.0 * t + 2.0 * std::sin(400.0 * t) + 0.02 * std::sin(9000.0 * t)),
                           Angle::degrees(10.0 + 24.0 * std::sin(7.0 * t) + 2.0 * std::cos(300.0 * t)), 0.0});
  }
  return {.lines = {std::move(line)}};
}

/// Tracks that go on by about 2 km a frame, each another way.
class Tracks {
 public:
  Tracks(int count, const Geodetic& middle, HeightMode heights) : heights_(heights) {
    const int across = static_cast<int>(std::lround(std::sqrt(double(count))));
    for (int k = 0; k < count; ++k) {
      const int column = k % across, row = k / across;
      const double east = double(column) / across - 0.5, north = double(row) / across - 0.5;
      ends_.push_back({middle.lat + Angle::degrees(30.0 * north), middle.lon + Angle::degrees(30.0 * east),
                       heights == HeightMode::absolute ? 1e4 : 0.0});
    }
  }
  ObjectScene scene() {
    constexpr int kFirstPlaces = 50;
    ObjectScene scene;
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      scene.lines.push_back({.of = {.id = ObjectId{k + 1}}, .heights = heights_});
      for (int step = 0; step < kFirstPlaces; ++step) scene.lines.back().places.push_back(next(k));
    }
    return scene;
  }
  ObjectEdits grow() {
    ObjectEdits edits;
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      edits.growths.push_back({.id = ObjectId{k + 1}, .append = {next(k)}, .drop_first = 1});
    }
    return edits;
  }

 private:
  Geodetic next(std::size_t k) {
    constexpr double kStep_deg = 0.02;
    const std::size_t frame = ++steps_ / ends_.size();
    const double way = 0.7 * double(k) + 0.02 * double(frame);
    ends_[k].lat = ends_[k].lat + Angle::degrees(kStep_deg * std::sin(way));
    ends_[k].lon = ends_[k].lon + Angle::degrees(kStep_deg * std::cos(way));
    return ends_[k];
  }

  HeightMode heights_;
  std::vector<Geodetic> ends_;
  std::size_t steps_ = 0;
};

/// A globe with one layer of objects, and the frames that are timed.
class GroundScene {
 public:
  GroundScene(const Geodetic& eye, bool relief, OffscreenTarget& target, Viewport size)
      : eye_(eye), target_(target), size_(size) {
    GlobeOptions how;
    how.upload_bytes_per_frame = how.gpu_bytes;
    how.upload_time_per_frame = std::chrono::seconds(1);
    globe_ = value_of(Globe::create(how, value_of(open_tile_set(data_file("earth.gpkg").string()))));
    if (relief) {
      const auto heights = wave_numbers(-6375.0, 50.0, {.floats = true, .unit = "m"});
      if (Status set = globe_->set_elevation(value_of(ElevationSource::open(heights, "waves"))); !set) {
        throw std::runtime_error(set.error().message);
      }
    }
    globe_->set_camera({.eye = eye_});
    settle();
    draw();
    bare_bytes_ = double(last_.gpu_bytes);
  }
  /// Adds objects. Returns the milliseconds until they are drawn.
  double add(ObjectScene scene) {
    const auto start = Clock::now();
    layer_ = value_of(globe_->add_objects(std::move(scene)));
    settle();
    return ms_since(start);
  }
  /// Makes edits. Returns the milliseconds of the call.
  double edit(ObjectEdits edits) {
    const auto start = Clock::now();
    if (Status done = globe_->edit_objects(layer_, std::move(edits)); !done) {
      throw std::runtime_error(done.error().message);
    }
    return ms_since(start);
  }
  void settle() {
    if (!globe_->render_until_settled(target_.framebuffer(), size_, Clock::now() + kLongestSettling)) {
      throw std::runtime_error("the globe has not settled in five minutes");
    }
  }
  void draw(const Geodetic& eye, Angle heading) {
    globe_->set_camera({.eye = eye, .heading = heading});
    last_ = globe_->render(target_.framebuffer(), size_);
  }
  /// Draws with a camera that turns.
  void draw() { draw(eye_, Angle::degrees(0.2 * (++turn_ % 8))); }
  /// Bytes of textures that the objects take.
  [[nodiscard]] double object_bytes() const { return double(last_.gpu_bytes) - bare_bytes_; }
  [[nodiscard]] const Geodetic& eye() const { return eye_; }
  /// The object in the middle of the picture.
  [[nodiscard]] ObjectId middle() const {
    const GlobePick pick = globe_->pick(0.5 * glm::dvec2(size_.width_px, size_.height_px), size_);
    if (!pick.object) throw std::runtime_error("no object is in the middle of the picture");
    return pick.object->of.id;
  }
  void finish() const { static_cast<void>(target_.read()); }

 private:
  Geodetic eye_;
  OffscreenTarget& target_;
  Viewport size_;
  std::unique_ptr<Globe> globe_;
  LayerId layer_ = LayerId::none;
  FrameStats last_ = {};
  double bare_bytes_ = 0.0;
  int turn_ = 0;
};

/// Lines and areas on the ground, as ratios to the bare globe of the same view.
class GroundBench {
 public:
  GroundBench(const BenchOptions& options, Report& report)
      : options_(options),
        report_(report),
        quick_(options.effort == Effort::quick),
        size_(object_picture(options.effort)),
        target_(size_) {}

  void run() {
    const Geodetic home{Angle::degrees(20), Angle::degrees(10), 3e6}, town{Angle::degrees(47), Angle::degrees(7), 2e3};
    Geodetic far = town;
    far.height_m = 2e6;
    const auto flat = HeightMode::absolute, draped = HeightMode::clamp_to_ground;
    const int many = quick_ ? 484 : 5000, small = quick_ ? 1000 : 100'000;
    add("bare", home, false, {}, "", 0.0);
    add("bare relief", home, true, {}, "", 0.0);
    add("bare, 2 km", town, false, {}, "", 0.0);
    add("bare, 2000 km", far, false, {}, "", 0.0);
    const std::string areas = fmt::format("{} areas", many);
    add(areas, home, false, districts(many, flat, {}, 160.0), "bare", 1.5, 1500.0);
    add(fmt::format("{} draped areas", many), home, true, districts(many, draped, {}, 160.0), "bare relief", 1.7,
        1500.0);
    add("a line of 200000 places", home, false, long_track(flat), "bare", 1.3, 500.0);
    add("the line, draped", home, true, long_track(draped), "bare relief", 1.3, 500.0);
    add(fmt::format("{} houses, 2 km", small), town, false, districts(small, flat, town, 0.2), "bare, 2 km", 2.0);
    add(fmt::format("{} houses, 2000 km", small), far, false, districts(small, flat, town, 0.2), "bare, 2000 km", 2.0);
    edits(areas, home, districts(many, flat, {}, 160.0));
    tracks("in the air", home, false, HeightMode::absolute, "bare");
    tracks("on the ground", home, true, HeightMode::clamp_to_ground, "bare relief");
    time_frames(subjects_, quick_ ? 2 : 15);
    for (std::size_t k = 0; k < subjects_.size(); ++k) {
      report_.rows.push_back(
          {subjects_[k].name, std::string("a frame"), kNoFigure, median(subjects_[k].whole_ms), std::int64_t{0}});
      const auto base = std::ranges::find(subjects_, bases_[k], &Subject::name);
      if (base == subjects_.end()) continue;
      const double ratio = median_ratio(subjects_[k].whole_ms, base->whole_ms);
      find(fmt::format("{}, of {}", subjects_[k].name, bases_[k]), ratio, limits_[k], "");
    }
    for (const auto& [name, ms] : calls_ms_) find(name + ", call", median(*ms), 2.0, "ms");
    if (GroundScene* scene = scene_of(areas)) recolor(*scene, many);
    if (GroundScene* scene = scene_of(areas)) {
      zoom(*scene, "the first time, with programs to compile", kNoFigure);
      zoom(*scene, "again", 3.0);
    }
  }

 private:
  void find(const std::string& what, double value, double limit, const std::string& unit) {
    report_.findings.push_back({what, value, quick_ ? kNoFigure : limit, unit});
  }
  void add(const std::string& name, Geodetic eye, bool relief, ObjectScene objects, const std::string& base,
           double limit, double settled_ms = 0.0) {
    if (!base.empty() && !options_.wants(name)) return;
    options_.progress(name);
    scenes_.push_back(std::make_unique<GroundScene>(eye, relief, target_, size_));
    GroundScene& scene = *scenes_.back();
    const bool any = !objects.empty();
    const double ms = any ? scene.add(std::move(objects)) : 0.0;
    if (settled_ms > 0.0) find(name + ", settled after add_objects()", ms, settled_ms, "ms");
    time(name, base, limit, [&scene] { scene.draw(); });
  }
  void time(const std::string& name, const std::string& base, double limit, std::function<void()> draw) {
    subjects_.push_back({name, std::move(draw)});
    bases_.push_back(base);
    limits_.push_back(limit);
  }
  GroundScene* scene_of(const std::string& name) {
    const auto at = std::ranges::find(subjects_, name, &Subject::name);
    return at == subjects_.end() ? nullptr : scenes_[static_cast<std::size_t>(at - subjects_.begin())].get();
  }
  /// Frames before which one area gets another colour. The one in the middle of the view is painted anew, and taken by
  /// the next frame.
  void edits(const std::string& areas, const Geodetic& eye, ObjectScene objects) {
    if (!options_.wants(areas)) return;
    GroundScene* scene = scenes_.emplace_back(std::make_unique<GroundScene>(eye, false, target_, size_)).get();
    scene->add(std::move(objects));
    const ObjectId middle = scene->middle();
    time(areas + ", one recoloured", areas, 1.3, [scene, middle, k = 0]() mutable {
      const auto shade = static_cast<std::uint8_t>(++k * 50);
      scene->edit({.changes = {{.id = middle, .fill = ObjectColor{shade, 90, 90, 140}}}});
      scene->draw();
    });
  }
  /// Frames before which each track gets a place and loses one.
  void tracks(const std::string& where, const Geodetic& eye, bool relief, HeightMode heights, const std::string& base) {
    const int count = quick_ ? 200 : 2000;
    const std::string name = fmt::format("{} tracks {}", count, where), grow = name + " grow";
    if (!options_.wants(name)) return;
    const auto all = std::make_shared<Tracks>(count, eye, heights);
    add(name, eye, relief, all->scene(), base, 1.5);
    const auto ms = std::make_shared<std::vector<double>>();
    calls_ms_.emplace_back(grow, ms);
    time(grow, base, 1.5, [scene = scenes_.back().get(), all, ms] {
      ObjectEdits edits = all->grow();
      ms->push_back(scene->edit(std::move(edits)));
      scene->draw();
    });
  }
  void recolor(GroundScene& scene, int count) {
    std::vector<double> call_ms, shown_ms;
    for (int round = 0; round < (quick_ ? 2 : 7); ++round) {
      scene.settle();
      ObjectEdits all;
      for (int k = 0; k < count; ++k) {
        const auto shade = static_cast<std::uint8_t>((k + round) * 50);
        all.changes.push_back(
            {.id = ObjectId{static_cast<std::uint64_t>(k) + 1}, .fill = ObjectColor{shade, 90, 90, 140}});
      }
      const auto start = Clock::now();
      call_ms.push_back(scene.edit(std::move(all)));
      scene.settle();
      scene.finish();
      shown_ms.push_back(ms_since(start));
    }
    find(fmt::format("{} areas recoloured, call", count), median(call_ms), kNoFigure, "ms");
    find(fmt::format("{} areas recoloured, until drawn", count), median(shown_ms), 30.0, "ms");
    find(fmt::format("{} areas, textures", count), 1e-6 * scene.object_bytes(), 64.0, "MB");
  }
  /// Zooms in by ten levels in two seconds.
  void zoom(GroundScene& scene, const std::string& time, double limit) {
    constexpr double kSeconds = 2.0, kLevels = 10.0;
    std::vector<double> ms;
    const auto start = Clock::now();
    for (double part = 0.0; part < 1.0; part = 1e-3 * ms_since(start) / kSeconds) {
      const auto frame = Clock::now();
      Geodetic eye = scene.eye();
      eye.height_m *= std::exp2(-kLevels * part);
      scene.draw(eye, {});
      scene.finish();
      ms.push_back(ms_since(frame));
    }
    const double longest = *std::ranges::max_element(ms);
    find(fmt::format("zooming ten levels in 2 s, {}: longest frame, of the median", time), longest / median(ms), limit,
         "");
  }

  const BenchOptions& options_;
  Report& report_;
  bool quick_;
  Viewport size_;
  OffscreenTarget target_;
  std::vector<std::unique_ptr<GroundScene>> scenes_;
  std::vector<Subject> subjects_;
  std::vector<std::string> bases_;
  std::vector<double> limits_;
  std::vector<std::pair<std::string, std::shared_ptr<std::vector<double>>>> calls_ms_;  ///< times of edits, by row
};

}  // namespace

void bench_ground(const BenchOptions& options, Report& report) { GroundBench(options, report).run(); }

}  // namespace terrella::bench
