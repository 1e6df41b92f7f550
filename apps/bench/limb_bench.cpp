#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/truth/limb_rows.h"
#include "apps/bench/value_of.h"
#include "apps/process/data_dir.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"
#include "streaming/sets/open_tile_set.h"
#include "tiles/painted_tiles.h"

namespace terrella::bench {
namespace {

using truth::Levels;
using truth::LimbPair;

constexpr int kTimes = 8;
constexpr int kCameras = 20;
constexpr int kPlaces = 3;  // by as many in each texel of the floes
constexpr std::array kSizes{200, 256, 320, 400, 512, 700, 1024, 1280, 1600, 2048};
constexpr std::array kChannels{"red", "green", "blue"};

/// A part of a picture, `size` pixels high, of a globe that fills five sixths of it: a strip along the limb. The camera
/// looks at the limb, whose pixels are as large as in the whole picture, from 1,000 km to 100,000 km.
struct Strip {
  static constexpr double kShare = 0.84, kAlong = 0.3;
  static constexpr int kMargin_px = 14;
  Viewport view;  ///< the limb runs along the upper edge
  Camera camera;
  Strip(int size, int k) {
    const double height_m = 1.0e6 * std::pow(100.0, k / (kCameras - 1.0));
    const double half_rad = std::asin(6378137.0 / (6378137.0 + height_m)), cosine = std::cos(half_rad);
    const double px_per_rad = 0.5 * kShare * size / (std::tan(half_rad) * cosine * cosine);
    const double bend_px = kAlong * kAlong / (4.0 * kShare) * size;
    view = {2 * static_cast<int>(0.5 * kAlong * size), 2 * static_cast<int>(kMargin_px + bend_px + 2.0)};
    const double lower_rad = (0.5 * view.height_px - kMargin_px) / px_per_rad;
    camera.eye = {.lat = Angle::degrees(-85.5 + 9.0 * k),
                  .lon = Angle::degrees(static_cast<double>((47 * k) % 180)),
                  .height_m = height_m};
    camera.heading = Angle::degrees(61.0 * k);
    camera.pitch = Angle::radians(half_rad - lower_rad - 0.5 * std::numbers::pi);
    camera.fov_y = Angle::radians(2.0 * std::atan(0.5 * view.height_px / px_per_rad));
  }
};

/// Painted land, sea and floes: a texel is the mean over the places in it, as in a pyramid of tiles.
std::shared_ptr<TileSource> painted_floes() {
  const TileGrid grid{.tile_px = 128, .max_level = 4};
  return painted_tiles(grid, [grid](const TileId& id) -> Result<Image, TileFailure> {
    const TileBounds b = tile_bounds(grid, id);
    const double step = (b.east_deg - b.west_deg) / (grid.tile_px * kPlaces);
    Image image{grid.tile_px, grid.tile_px, {}};
    for (int k = 0; k < grid.tile_px * grid.tile_px; ++k) {
      std::array<double, 3> sum{};
      for (int p = 0; p < kPlaces * kPlaces; ++p) {
        const int x = kPlaces * (k % grid.tile_px) + p % kPlaces, y = kPlaces * (k / grid.tile_px) + p / kPlaces;
        const auto color = truth::floe_color(b.west_deg + (x + 0.5) * step, b.north_deg - (y + 0.5) * step);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c];
      }
      for (const double s : sum) image.rgba.push_back(static_cast<std::uint8_t>(s / (kPlaces * kPlaces) + 0.5));
      image.rgba.push_back(255);
    }
    return image;
  });
}

/// Turned, so that the limb is on the left.
Levels turned(const Levels& p) {
  Levels out{p.height, p.width, {}};
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 3; ++c) out.values.push_back(p.at(y, x, c));
  return out;
}

/// Draws a strip; also returns the time of the settled frame.
std::pair<Levels, double> draw_strip(Globe& globe, const Strip& strip, int times) {
  const Viewport size{times * strip.view.width_px, times * strip.view.height_px};
  const OffscreenTarget target{size};
  const auto late = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  if (!globe.render_until_settled(target.framebuffer(), size, late))
    throw std::runtime_error("the globe has not settled in five minutes");
  const FrameTime time = time_frame([&] { globe.render(target.framebuffer(), size); });
  return {turned(truth::reduced(target.read(), size.width_px, size.height_px, times)), time.cpu_ms};
}

double percent_off(double drawn, double truth) { return 100.0 * std::abs(drawn - truth) / std::max(1e-9, truth); }

/// The strips of one size of a globe, with a sky or without.
struct LimbSum {
  std::vector<double> peaks, changes, ms;  ///< percent off; processor time
  std::int64_t outside = 0;
  std::string worst;  ///< those outside the limits, by camera and channel
};

LimbSum measure_limbs(Globe& globe, int size, int every) {
  LimbSum sum;
  for (int k = 0; k < kCameras; k += every) {
    const Strip strip(size, k);
    globe.set_camera(strip.camera);
    const Levels larger = draw_strip(globe, strip, kTimes).first;
    const auto [seen, ms] = draw_strip(globe, strip, 1);
    sum.ms.push_back(ms);
    for (int c = 0; c < 3; ++c) {
      const LimbPair limb = truth::compare_limbs(seen, larger, 0, seen.height, c);
      sum.peaks.push_back(percent_off(limb.drawn.peak, limb.truth.peak));
      sum.changes.push_back(percent_off(limb.drawn.change, limb.truth.change));
      if (limb.peak_agrees() && limb.change_agrees()) continue;
      ++sum.outside;
      sum.worst += fmt::format("{}{} {}: peak {:.1f} of {:.1f}, change {:.2f} of {:.2f}", sum.worst.empty() ? "" : "; ",
                               k, kChannels[static_cast<std::size_t>(c)], limb.drawn.peak, limb.truth.peak,
                               limb.drawn.change, limb.truth.change);
    }
  }
  return sum;
}

void add_limb_rows(const BenchOptions& options, const std::string& ground, std::shared_ptr<TileSource> tiles,
                   Report& report) {
  if (!options.wants(ground)) return;
  const auto globe = value_of(Globe::create({.sky = true}, std::move(tiles)));
  const int largest = options.effort == Effort::quick ? 200 : options.effort == Effort::full ? 2048 : 512;
  const int every = options.effort == Effort::quick ? 10 : 1;
  for (const int size : kSizes) {
    for (const bool sky : {true, false}) {
      if (size > largest) continue;
      options.progress(fmt::format("{}, {} pixels, {} sky", ground, size, sky ? "with a" : "without a"));
      globe->set_sky(sky);
      const LimbSum sum = measure_limbs(*globe, size, every);
      report.rows.push_back({ground, std::int64_t{size}, std::string(sky ? "yes" : "no"), median(sum.ms),
                             median(sum.peaks), std::ranges::max(sum.peaks), median(sum.changes),
                             std::ranges::max(sum.changes), sum.outside, static_cast<std::int64_t>(sum.peaks.size()),
                             sum.worst});
    }
  }
}

}  // namespace

Result<Report> bench_limb(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  Report report{.name = "limb",
                .title = "Strips along the limb beside the same pictures drawn 8 by 8 times as large",
                .facts = {{"renderer", renderer_name()},
                          {"limits",
                           "the peak within 5 % and a level, its change from row to row within 10 % and half "
                           "a level"}},
                .columns = {{"ground", ""},
                            {"size", "pixels"},
                            {"sky", ""},
                            {"time", "ms of processor, median", 1},
                            {"peak_off", "%, median", 1},
                            {"peak_worst", "%", 1},
                            {"change_off", "%, median", 1},
                            {"change_worst", "%", 1},
                            {"outside", "of the limits"},
                            {"cases", ""},
                            {"which", "camera and channel"}}};
  report.plots = {
      {.title = "changes off", .x = "size", .y = "change_off", .series = "ground", .only = {{"sky", {"no"}}}}};
  try {
    add_limb_rows(options, "floes", painted_floes(), report);
    add_limb_rows(options, "earth", value_of(open_tile_set(data_file("earth.gpkg").string())), report);
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
  return report;
}

}  // namespace terrella::bench
