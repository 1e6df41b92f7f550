// Two pictures of one scene side by side: an opaque globe's order with transparency just switched on, as paper 2 begins
// with, and the globe as it is drawn. Takes what `terrella render` takes.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

#include "apps/open_scene/bounds_view.h"
#include "apps/open_scene/open_scene.h"
#include "apps/open_scene/options/scene_options.h"
#include "apps/open_scene/scene_objects.h"
#include "apps/process/write_file.h"
#include "codecs/image.h"
#include "globe/experiments.h"
#include "render/gl/offscreen.h"

namespace {

using namespace terrella;

constexpr int kGap_px = 8;

template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

std::vector<std::uint8_t> draw(const SceneOptions& scene, bool naive) {
  const OpenedScene opened = value_of(open_scene(scene, [&](const Body& body) -> Result<GlobeOptions> {
    GlobeOptions options = globe_options(scene, body);
    add_sky_data(options, options.time.has_value());
    return options;
  }));
  const auto& globe = opened.globe;
  Experiments::of(*globe).naive_translucency = naive;
  // The order of two mountains is chance; in this order some of those behind come first.
  if (naive) Experiments::of(*globe).patch_shuffle = 5U;
  globe->set_camera(scene.camera.value_or(default_camera({}, opened.body.ellipsoid, scene.size)));
  const OffscreenTarget target(scene.size);
  globe->render_until_settled(target.framebuffer(), scene.size,
                              std::chrono::steady_clock::now() + std::chrono::minutes(1));
  return target.read();
}

Image side_by_side(Viewport size, const std::vector<std::uint8_t>& left, const std::vector<std::uint8_t>& right) {
  const auto row = static_cast<std::size_t>(size.width_px) * 4, gap = std::size_t{kGap_px} * 4;
  Image both{2 * size.width_px + kGap_px, size.height_px, {}};
  both.rgba.assign((2 * row + gap) * static_cast<std::size_t>(size.height_px), 255);
  for (std::size_t y = 0; y < static_cast<std::size_t>(size.height_px); ++y) {
    const auto at = [&](std::size_t offset) { return both.rgba.data() + y * (2 * row + gap) + offset; };
    std::copy_n(left.data() + y * row, row, at(0));
    std::copy_n(right.data() + y * row, row, at(row + gap));
  }
  return both;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A scene twice: transparency just switched on, and as Terrella draws it");
  SceneOptions scene;
  std::string output;
  add_scene_options(app, scene);
  app.add_option("-o,--output", output, "PNG file")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    const auto context = value_of(HeadlessContext::create());
    const auto png = value_of(encode_png(side_by_side(scene.size, draw(scene, true), draw(scene, false))));
    if (const Status written = write_file(output, png); !written) throw std::runtime_error(written.error().message);
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "{}\n", wrong.what());
    return 1;
  }
  return 0;
}
