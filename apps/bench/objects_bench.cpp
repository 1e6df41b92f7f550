#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/sources/wave_numbers.h"
#include "apps/bench/value_of.h"
#include "apps/open_scene/scene_objects.h"
#include "apps/process/data_dir.h"
#include "render/gl/offscreen.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr Viewport kPicture{1024, 1024};
constexpr std::chrono::seconds kLongest{300};
constexpr int kFrames = 15;

double processor_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

/// An arrow.
std::shared_ptr<const IconImage> arrow() {
  constexpr int kSide = 32;
  IconImage icon{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto ink = static_cast<std::uint8_t>(2 * std::abs(x - kSide / 2) < y ? 255 : 0);
      icon.rgba.insert(icon.rgba.end(), {255, 200, 40, ink});
    }
  }
  return std::make_shared<const IconImage>(std::move(icon));
}

/// Places of moving objects: a random walk of `count` places at flying heights.
class Traffic {
 public:
  explicit Traffic(int count) {
    std::uniform_real_distribution<double> sine(-1.0, 1.0), lon(-180.0, 180.0), height(1e3, 12e3);
    for (int k = 0; k < count; ++k) {
      places_.push_back({Angle::radians(std::asin(sine(random_))), Angle::degrees(lon(random_)), height(random_)});
    }
  }
  void step() {
    std::uniform_real_distribution<double> step(-0.05, 0.05);
    for (Geodetic& place : places_) {
      place.lat = Angle::degrees(std::clamp(place.lat.deg() + step(random_), -90.0, 90.0));
      place.lon = place.lon + Angle::degrees(step(random_));
    }
  }
  [[nodiscard]] ObjectScene scene() const {
    static const auto icon = arrow();
    ObjectScene scene;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      scene.points.push_back({.place = places_[k],
                              .size_px = 16.0F,
                              .icon = {.image = icon, .heading = heading(k), .from_north = true},
                              .of = {.id = ObjectId{k + 1}}});
      scene.labels.push_back(
          {.text = fmt::format("TE {}", k), .place = places_[k], .size_px = 16.0F, .of = {.id = ObjectId{k + 1}}});
    }
    return scene;
  }
  [[nodiscard]] ObjectEdits moves(std::size_t count) const {
    ObjectEdits edits;
    edits.moves.reserve(count);
    for (std::size_t k = 0; k < count; ++k) edits.moves.push_back({ObjectId{k + 1}, places_[k], heading(k)});
    return edits;
  }
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  [[nodiscard]] Angle heading(std::size_t k) const { return Angle::degrees(40.0 * places_[k].lat.deg() + double(k)); }

  std::mt19937 random_{3};
  std::vector<Geodetic> places_;
};

/// `count` areas of 100 corners, of the sizes of countries and their islands: 0.3° to 12° across.
ObjectScene countries(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> lat(-65.0, 70.0), lon(-180.0, 180.0), size(-0.5, 1.08), coast(0.8, 1.2);
  ObjectScene scene;
  for (int k = 0; k < count; ++k) {
    const double middle_lat = lat(random), middle_lon = lon(random);
    PolygonObject area{.rings = {{}}, .of = {.id = ObjectId{static_cast<std::uint64_t>(k) + 1}}};
    const double reach = 0.5 * std::pow(10.0, size(random));
    for (int corner = 0; corner < 100; ++corner) {
      const double way = 2.0 * M_PI * corner / 100.0, far = reach * coast(random);
      area.rings[0].push_back(
          {Angle::degrees(middle_lat + far * std::sin(way)), Angle::degrees(middle_lon + far * std::cos(way)), 0.0});
    }
    scene.polygons.push_back(std::move(area));
  }
  return scene;
}

class ObjectBench {
 public:
  ObjectBench(const BenchOptions& options, Report& report)
      : options_(options), report_(report), quick_(options.effort == Effort::quick), target_(kPicture) {
    GlobeOptions how;
    add_label_font(how);
    globe_ = value_of(Globe::create(how));
    globe_->set_camera({.eye = {.lat = Angle::degrees(20), .lon = Angle::degrees(10), .height_m = 8e6}});
  }

  void run() {
    Traffic traffic(quick_ ? 1000 : 10'000);
    const ObjectScene areas = countries(quick_ ? 50 : 2000);
    const LayerId ground = value_of(globe_->add_objects(areas)), air = value_of(globe_->add_objects(traffic.scene()));
    settle();
    const auto edit = [&](LayerId layer, ObjectEdits edits) { check(globe_->edit_objects(layer, std::move(edits))); };
    const std::string all = fmt::format("{} positions", traffic.size());
    measure("nothing", "a frame", kFrames, [] {});
    ObjectEdits moves;
    measure(
        all, "edit_objects", kFrames, [&] { edit(air, std::move(moves)); },
        [&] { traffic.step(), moves = traffic.moves(traffic.size()); });
    measure(
        "1 position", "edit_objects", kFrames, [&] { edit(air, std::move(moves)); },
        [&] { traffic.step(), moves = traffic.moves(1); });
    bool selected = false;
    measure("an area is highlighted", "edit_objects", kFrames,
            [&] { edit(ground, {.changes = {{.id = ObjectId{7}, .selected = selected = !selected}}}); });
    ObjectScene scene;
    measure(
        all, "set_objects", 3, [&] { check(globe_->set_objects(air, std::move(scene))); },
        [&] { scene = traffic.scene(); });
    measure(
        "1 position", "set_objects", 3, [&] { check(globe_->set_objects(air, std::move(scene))); },
        [&] { scene = traffic.scene(); });
    measure(
        "an area is highlighted", "set_objects", 3, [&] { check(globe_->set_objects(ground, std::move(scene))); },
        [&] { scene = areas; });
    check(globe_->remove(air));
    check(globe_->remove(ground));
    picks(quick_ ? 10'000 : 100'000);
    limits(all);
  }

 private:
  static void check(const Status& done) {
    if (!done) throw std::runtime_error(done.error().message);
  }

  /// Draws frames until settled, none of them in vain; returns the number of objects that were tessellated.
  std::size_t settle() {
    std::size_t cut = 0;
    const auto late = Clock::now() + kLongest;
    do {
      cut += globe_->render(target_.framebuffer(), kPicture).objects_cut;
      while (!globe_->settled() && !globe_->needs_frame()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (Clock::now() > late) throw std::runtime_error("the objects have not settled in five minutes");
    } while (!globe_->settled());
    static_cast<void>(target_.read());
    return cut;
  }

  void measure(
      const std::string& what, const std::string& how, int rounds, const std::function<void()>& call,
      const std::function<void()>& before = [] {}) {
    if (!options_.wants(what)) return;
    options_.progress(what + ", " + how);
    std::vector<double> call_ms, shown_ms;
    std::size_t cut = 0;
    for (int round = 0; round < rounds; ++round) {
      before();
      const double process = processor_ms(CLOCK_PROCESS_CPUTIME_ID), thread = processor_ms(CLOCK_THREAD_CPUTIME_ID);
      call();
      call_ms.push_back(processor_ms(CLOCK_THREAD_CPUTIME_ID) - thread);
      cut = settle();
      shown_ms.push_back(processor_ms(CLOCK_PROCESS_CPUTIME_ID) - process);
    }
    report_.rows.push_back({what, how, median(call_ms), median(shown_ms), static_cast<std::int64_t>(cut)});
  }

  void picks(int count) {
    const std::string what = fmt::format("a pick among {} points", count);
    if (!options_.wants(what)) return;
    options_.progress(what);
    const ObjectScene scene = Traffic(count).scene();
    const LayerId layer = value_of(globe_->add_objects({.points = scene.points}));
    settle();
    std::mt19937 random(8);
    std::uniform_real_distribution<double> pixel(0.0, kPicture.width_px);
    const auto row = [&](const char* how, int rounds, const auto& pick) {
      std::vector<double> ms;
      for (int round = 0; round < rounds; ++round) {
        const glm::dvec2 at(pixel(random), pixel(random));
        const double start = processor_ms(CLOCK_THREAD_CPUTIME_ID);
        pick(at);
        ms.push_back(processor_ms(CLOCK_THREAD_CPUTIME_ID) - start);
      }
      report_.rows.push_back({what, std::string(how), median(ms), kNoFigure, std::int64_t{0}});
    };
    static_cast<void>(globe_->pick({512.0, 512.0}, kPicture));  // makes the index
    row("pick", 200, [&](glm::dvec2 at) { static_cast<void>(globe_->pick(at, kPicture)); });
    const View view = globe_->view(kPicture);
    const Ground ground = globe_->ground();
    row("scan", 10, [&](glm::dvec2 at) { static_cast<void>(pick_object(view, ground, scene, at)); });
    check(globe_->remove(layer));
  }

  void limits(const std::string& all) {
    const auto add = [this](const std::string& what, const std::string& how, double limit_ms) {
      for (const auto& row : report_.rows) {
        if (std::get<std::string>(row[0]).find(what) != 0 || std::get<std::string>(row[1]) != how) continue;
        report_.findings.push_back(
            {fmt::format("{}, {}", what, how), std::get<double>(row[2]), quick_ ? kNoFigure : limit_ms, "ms"});
      }
    };
    add(all, "edit_objects", 2.0);
    add("1 position", "edit_objects", 0.02);
    add("an area is highlighted", "edit_objects", 0.1);
    add("a pick among", "pick", 0.1);
    const auto shown_ms = [this](const std::string& what) {
      for (const auto& row : report_.rows) {
        if (std::get<std::string>(row[0]) == what) return std::get<double>(row[3]);
      }
      return std::nan("");
    };
    const double ratio = shown_ms(all) / shown_ms("nothing");
    if (std::isfinite(ratio)) {
      report_.findings.push_back({"a frame after all moved, to one of nothing", ratio, quick_ ? kNoFigure : 1.1, ""});
    }
  }

  const BenchOptions& options_;
  Report& report_;
  bool quick_;
  OffscreenTarget target_;
  std::unique_ptr<Globe> globe_;
};

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

/// Lines and areas on the ground, as ratios to the bare globe of the same view. The camera turns.
class GroundBench {
 public:
  GroundBench(const BenchOptions& options, Report& report)
      : options_(options), report_(report), quick_(options.effort == Effort::quick), target_(kPicture) {}

  void run() {
    const Geodetic home{Angle::degrees(20), Angle::degrees(10), 3e6}, town{Angle::degrees(47), Angle::degrees(7), 2e3};
    Geodetic far = town;
    far.height_m = 2e6;
    const auto flat = HeightMode::absolute, draped = HeightMode::clamp_to_ground;
    const int many = quick_ ? 500 : 5000, small = quick_ ? 1000 : 100'000;
    add("bare", home, false, {}, "", 0.0);
    add("bare relief", home, true, {}, "", 0.0);
    add("bare, 2 km", town, false, {}, "", 0.0);
    add("bare, 2000 km", far, false, {}, "", 0.0);
    add(fmt::format("{} areas", many), home, false, districts(many, flat, {}, 160.0), "bare", 1.5, 1500.0);
    add(fmt::format("{} draped areas", many), home, true, districts(many, draped, {}, 160.0), "bare relief", 1.7,
        1500.0);
    add("a line of 200000 places", home, false, long_track(flat), "bare", 1.3, 500.0);
    add("the line, draped", home, true, long_track(draped), "bare relief", 1.3, 500.0);
    add(fmt::format("{} houses, 2 km", small), town, false, districts(small, flat, town, 0.2), "bare, 2 km", 2.0);
    add(fmt::format("{} houses, 2000 km", small), far, false, districts(small, flat, town, 0.2), "bare, 2000 km", 2.0);
    time_frames(subjects_, quick_ ? 2 : 15);
    for (std::size_t k = 0; k < subjects_.size(); ++k) {
      report_.rows.push_back(
          {subjects_[k].name, std::string("a frame"), kNoFigure, median(subjects_[k].cpu_ms), std::int64_t{0}});
      const auto base = std::ranges::find(subjects_, bases_[k], &Subject::name);
      if (base == subjects_.end()) continue;
      const double ratio = median_ratio(subjects_[k].cpu_ms, base->cpu_ms);
      report_.findings.push_back(
          {subjects_[k].name + ", of the bare globe", ratio, quick_ ? kNoFigure : limits_[k], ""});
    }
  }

 private:
  void add(const std::string& name, Geodetic eye, bool relief, ObjectScene scene, const std::string& base, double limit,
           double settled_ms = 0.0) {
    if (!base.empty() && !options_.wants(name)) return;
    options_.progress(name);
    GlobeOptions how;
    how.upload_bytes_per_frame = how.gpu_bytes;
    how.upload_time_per_frame = std::chrono::seconds(1);
    globes_.push_back(value_of(Globe::create(how, value_of(open_tile_set(data_file("earth.gpkg").string())))));
    Globe& globe = *globes_.back();
    if (relief) {
      const auto heights = wave_numbers(-6375.0, 50.0, {.floats = true, .unit = "m"});
      if (Status set = globe.set_elevation(value_of(ElevationSource::open(heights, "waves"))); !set) {
        throw std::runtime_error(set.error().message);
      }
    }
    globe.set_camera({.eye = eye});
    settle(globe);
    const auto start = Clock::now();
    if (!scene.empty()) static_cast<void>(value_of(globe.add_objects(std::move(scene))));
    settle(globe);
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    if (settled_ms > 0.0) {
      report_.findings.push_back({name + ", settled after add_objects()", ms, quick_ ? kNoFigure : settled_ms, "ms"});
    }
    subjects_.push_back({name, [this, &globe, eye, turn = 0]() mutable {
                           globe.set_camera({.eye = eye, .heading = Angle::degrees(0.2 * (++turn % 8))});
                           globe.render(target_.framebuffer(), kPicture);
                         }});
    bases_.push_back(base);
    limits_.push_back(limit);
  }
  void settle(Globe& globe) {
    if (!globe.render_until_settled(target_.framebuffer(), kPicture, Clock::now() + kLongest)) {
      throw std::runtime_error("the globe has not settled in five minutes");
    }
  }

  const BenchOptions& options_;
  Report& report_;
  bool quick_;
  OffscreenTarget target_;
  std::vector<std::unique_ptr<Globe>> globes_;
  std::vector<Subject> subjects_;
  std::vector<std::string> bases_;
  std::vector<double> limits_;
};

}  // namespace

Result<Report> bench_objects(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  Report report{
      .name = "objects",
      .title = "Edits of single objects beside a scene that is set anew",
      .facts = {{"renderer", renderer_name()},
                {"time", "processor time: of the calling thread, and of the process until the change is drawn"}},
      .columns = {{"change", ""},
                  {"by", ""},
                  {"call", "ms of the thread", 4},
                  {"shown", "ms of the process", 1},
                  {"cut", "objects tessellated"}}};
  report.plots = {{.title = "time of the call", .x = "shown", .y = "call", .series = "by", .lines = false}};
  try {
    ObjectBench(options, report).run();
    GroundBench(options, report).run();
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
  return report;
}

}  // namespace terrella::bench
