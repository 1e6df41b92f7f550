// Strips along the limb of the globe beside the same pictures drawn 8 by 8 times as large: 10 sizes, 20 cameras, with
// and without a sky. Prints the table of apps/bench/RESULTS.md and the cases outside the limits.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "globe/globe.h"
#include "render/gl/offscreen.h"
#include "streaming/sets/open_tile_set.h"
#include "tests/gl/limb_rows.h"

namespace {

using namespace terrella;
using test::LimbPair;
using Clock = std::chrono::steady_clock;

constexpr int kTimes = 8;
constexpr int kSizes[] = {200, 256, 320, 400, 512, 700, 1024, 1280, 1600, 2048};
constexpr int kCameras = 20;
constexpr const char* kChannels[] = {"red", "green", "blue"};

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
                  .lon = Angle::degrees(47.0 * k - 180.0 * ((47 * k) / 180)),
                  .height_m = height_m};
    camera.heading = Angle::degrees(61.0 * k);
    camera.pitch = Angle::radians(half_rad - lower_rad - 0.5 * std::numbers::pi);
    camera.fov_y = Angle::radians(2.0 * std::atan(0.5 * view.height_px / px_per_rad));
  }
};

/// Turned, so that the limb is on the left.
test::Levels turned(const test::Levels& p) {
  test::Levels out{p.height, p.width, {}};
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 3; ++c) out.values.push_back(p.at(y, x, c));
  return out;
}

test::Levels drawn(Globe& globe, const Strip& strip, int times) {
  const Viewport size{times * strip.view.width_px, times * strip.view.height_px};
  const OffscreenTarget target{size};
  if (!globe.render_until_settled(target.framebuffer(), size, Clock::now() + std::chrono::minutes(5)))
    throw std::runtime_error("the globe has not settled after five minutes");
  globe.render(target.framebuffer(), size);
  return turned(test::reduced(target.read(), size, times));
}

struct Case {
  int size, camera;
  bool sky;
  int channel;
  LimbPair limb;
  [[nodiscard]] double peak_off() const {
    return std::abs(limb.drawn.peak - limb.truth.peak) / std::max(1e-9, limb.truth.peak);
  }
  [[nodiscard]] double change_off() const {
    return std::abs(limb.drawn.change - limb.truth.change) / std::max(1e-9, limb.truth.change);
  }
};

void measure(Globe& globe, int size, bool sky, int k, std::vector<Case>& cases) {
  const Strip strip(size, k);
  globe.set_sky(sky);
  globe.set_camera(strip.camera);
  const test::Levels truth = drawn(globe, strip, kTimes), seen = drawn(globe, strip, 1);
  for (int c = 0; c < 3; ++c) cases.push_back({size, k, sky, c, test::compare_limbs(seen, truth, 0, seen.height, c)});
}

double quantile(std::vector<double> values, double part) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
}

void print_row(const std::vector<Case>& cases, int size, bool sky) {
  std::vector<double> peaks, changes;
  int outside = 0;
  for (const Case& c : cases) {
    if (c.size != size || c.sky != sky) continue;
    peaks.push_back(100.0 * c.peak_off());
    changes.push_back(100.0 * c.change_off());
    outside += c.limb.peak_agrees() && c.limb.change_agrees() ? 0 : 1;
  }
  fmt::print("| {} | {} | {:.1f}, {:.1f} | {:.1f}, {:.1f} | {} of {} |\n", size, sky ? "yes" : "no",
             quantile(peaks, 0.5), quantile(peaks, 1.0), quantile(changes, 0.5), quantile(changes, 1.0), outside,
             peaks.size());
  std::fflush(stdout);
}

void print_outside(const std::vector<Case>& cases) {
  fmt::print(
      "\nOutside the limits:\n\n| size | camera | sky | channel | peak, truth | change, truth |\n"
      "|---|---|---|---|---|---|\n");
  for (const Case& c : cases) {
    if (c.limb.peak_agrees() && c.limb.change_agrees()) continue;
    fmt::print("| {} | {} | {} | {} | {:.1f}, {:.1f} | {:.2f}, {:.2f} |\n", c.size, c.camera, c.sky ? "yes" : "no",
               kChannels[c.channel], c.limb.drawn.peak, c.limb.truth.peak, c.limb.drawn.change, c.limb.truth.change);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("The limb beside the same picture drawn 8 by 8 times as large");
  int smallest = 200, largest = 2048, every = 1;
  app.add_option("--smallest", smallest, "smallest size, pixels");
  app.add_option("--largest", largest, "largest size, pixels");
  std::string tiles;
  app.add_option("--tiles", tiles, "a tile set in place of the painted land, sea and floes");
  app.add_option("--every", every, "every n-th camera only")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    const auto context = HeadlessContext::create();
    if (!context) throw std::runtime_error(context.error().message);
    GlobeOptions options;
    options.sky = true;
    std::shared_ptr<TileSource> source = test::floes();
    if (!tiles.empty()) {
      auto opened = open_tile_set(tiles);
      if (!opened) throw std::runtime_error(opened.error().message);
      source = *std::move(opened);
    }
    auto globe = Globe::create(options, source);
    if (!globe) throw std::runtime_error(globe.error().message);
    fmt::print(
        "| size | sky | peak off, %: median, worst | change off, %: median, worst | outside the limits |\n"
        "|---|---|---|---|---|\n");
    std::vector<Case> cases;
    for (const int size : kSizes) {
      if (size < smallest || size > largest) continue;
      for (const bool sky : {true, false}) {
        for (int k = 0; k < kCameras; k += every) measure(**globe, size, sky, k, cases);
        print_row(cases, size, sky);
      }
    }
    print_outside(cases);
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "{}\n", wrong.what());
    return 1;
  }
  return 0;
}
