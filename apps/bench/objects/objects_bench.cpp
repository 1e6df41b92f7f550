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
#include "apps/bench/objects/ground_bench.h"
#include "apps/bench/value_of.h"
#include "apps/open_scene/scene_objects.h"
#include "render/gl/offscreen.h"

namespace terrella::bench {
namespace {

using Clock = std::chrono::steady_clock;

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
      : options_(options),
        report_(report),
        quick_(options.effort == Effort::quick),
        size_(object_picture(options.effort)),
        target_(size_) {
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
    const int frames = quick_ ? 5 : 15;
    measure("nothing", "a frame", frames, [] {});
    ObjectEdits moves;
    measure(
        all, "edit_objects", frames, [&] { edit(air, std::move(moves)); },
        [&] { traffic.step(), moves = traffic.moves(traffic.size()); });
    measure(
        "1 position", "edit_objects", frames, [&] { edit(air, std::move(moves)); },
        [&] { traffic.step(), moves = traffic.moves(1); });
    bool selected = false;
    measure("an area is highlighted", "edit_objects", frames,
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
    const auto late = Clock::now() + kLongestSettling;
    do {
      cut += globe_->render(target_.framebuffer(), size_).objects_cut;
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
    std::uniform_real_distribution<double> pixel(0.0, size_.width_px);
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
    static_cast<void>(globe_->pick({0.5 * size_.width_px, 0.5 * size_.height_px}, size_));  // makes the index
    row("pick", 200, [&](glm::dvec2 at) { static_cast<void>(globe_->pick(at, size_)); });
    const View view = globe_->view(size_);
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
  Viewport size_;
  OffscreenTarget target_;
  std::unique_ptr<Globe> globe_;
};

}  // namespace

Result<Report> bench_objects(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  Report report{
      .name = "objects",
      .title = "Edits of single objects beside a scene that is set anew",
      .facts = {{"renderer", renderer_name()},
                {"time", "processor time: of the calling thread, and of the process until the change is drawn"},
                {"frames", "processor time on software GL, else wall time with a finish"}},
      .columns = {{"change", ""},
                  {"by", ""},
                  {"call", "ms of the thread", 4},
                  {"shown", "ms of the process", 1},
                  {"cut", "objects tessellated"}}};
  report.plots = {{.title = "time of the call", .x = "shown", .y = "call", .series = "by", .lines = false}};
  try {
    ObjectBench(options, report).run();
    bench_ground(options, report);
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
  return report;
}

}  // namespace terrella::bench
