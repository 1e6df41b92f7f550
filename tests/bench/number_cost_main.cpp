// Measures a layer of numbers beside the picture of the same numbers: frames in turn in one run, and bytes.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/bench/frame_timing.h"
#include "render/gl/offscreen.h"
#include "tests/gl/painted_numbers.h"

namespace {

using namespace terrella;
using bench::Subject;
using Clock = std::chrono::steady_clock;

constexpr Viewport kSize{1024, 1024};
constexpr TileGrid kGrid{.tile_px = 256, .max_level = 7};
constexpr float kLow = 0.0F, kHigh = 255.0F;

float waves(double lon, double row) {
  const double around = lon * M_PI / 180.0, north = row * M_PI / 180.0;
  return static_cast<float>(127.5 + 60.0 * std::sin(37.0 * north) * std::cos(23.0 * around) +
                            60.0 * std::cos(5.0 * north) * std::sin(71.0 * around));
}

/// The same tiles as pictures, with the colours of the look.
class Pictures : public TileSource {
 public:
  Pictures(std::shared_ptr<TileSource> numbers, const NumberLook& look)
      : numbers_(std::move(numbers)), look_(look), info_(numbers_->info()) {
    info_.numbers.reset();
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    const auto tile = numbers_->read(id);
    if (!tile) return tile.error();
    EncodedTile picture;
    picture.make_picture = [make = tile->make_numbers, look = look_]() -> Result<Image, TileFailure> {
      const auto numbers = make();
      Image image{numbers->width_px, numbers->height_px, {}};
      for (const float number : numbers->values) {
        const Rgba8 c = color_of(look, static_cast<double>(number));
        image.rgba.insert(image.rgba.end(), {c.r, c.g, c.b, c.a});
      }
      return image;
    };
    return picture;
  }

 private:
  std::shared_ptr<TileSource> numbers_;
  NumberLook look_;
  TileSetInfo info_;
};

struct Layer {
  std::string name;
  std::shared_ptr<TileSource> source;
  ImageLook look;
};

std::vector<Layer> layers(const NumberLook& look) {
  const auto numbers = [](const NumberInfo& info) {
    return std::make_shared<test::PaintedNumbers>(kGrid, waves, info);
  };
  const auto pictures = std::make_shared<Pictures>(numbers({.floats = true}), look);
  ImageLook stretched;
  stretched.numbers = look;
  return {{"picture, 8 bits a channel", pictures, {}},
          {"the same again", pictures, {}},
          {"numbers, 16 bits", numbers({.floats = true, .whole = WholeRange{0, 255}}), stretched},
          {"numbers, 32-bit floats", numbers({.floats = true}), stretched}};
}

std::unique_ptr<Globe> make_globe(const Layer& layer, Texturing texturing) {
  GlobeOptions options;
  options.texturing = texturing;
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  auto globe = Globe::create(options);
  if (!globe) throw std::runtime_error(globe.error().message);
  if (const auto added = (*globe)->add_imagery(layer.source, layer.look); !added) {
    throw std::runtime_error(added.error().message);
  }
  return *std::move(globe);
}

struct Case {
  const char* name;
  const char* camera;
  Texturing texturing = Texturing::automatic;
};
constexpr Case kCases[] = {{"four radii, 10 N 20 E", "10,20,19134411"},
                           {"over the pole", "90,0,19134411"},
                           {"slanted, 500 km", "46,7,500000,30,-25"},
                           {"near, magnified", "46,7,2000"},
                           {"four radii, every patch polar", "10,20,19134411", Texturing::exact}};

void measure(const Case& view, int rounds, const NumberLook& look) {
  OffscreenTarget target{kSize};
  std::vector<std::unique_ptr<Globe>> globes;
  std::vector<Subject> subjects;
  std::vector<std::size_t> bytes;
  for (const Layer& layer : layers(look)) {
    globes.push_back(make_globe(layer, view.texturing));
    Globe& globe = *globes.back();
    globe.set_camera(*parse_camera(view.camera));
    if (!globe.render_until_settled(target.framebuffer(), kSize, Clock::now() + std::chrono::seconds(120))) {
      throw std::runtime_error("the globe has not settled after two minutes");
    }
    bytes.push_back(globe.render(target.framebuffer(), kSize).gpu_bytes);
    subjects.push_back({layer.name, [&globe, &target] { globe.render(target.framebuffer(), kSize); }});
  }
  bench::time_frames(subjects, rounds);
  for (std::size_t k = 0; k < subjects.size(); ++k) {
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.1f} |\n", view.name, subjects[k].name,
               bench::median_ratio(subjects[k].cpu_ms, subjects[0].cpu_ms),
               bench::median_ratio(subjects[k].ms, subjects[0].ms), static_cast<double>(bytes[k]) / (1 << 20));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Cost of layers of numbers as a ratio to the picture of the same numbers, in one run");
  int rounds = 15;
  app.add_option("--rounds", rounds, "frames of each subject");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto context = HeadlessContext::create();
    if (!context) throw std::runtime_error(context.error().message);
    fmt::print("{}, {}\n\n| view | layer | processor | {} | slots, MiB |\n|---|---|---|---|---|\n",
               bench::renderer_name(), bench::timing_method(), "frame");
    const NumberLook look{.low = kLow, .high = kHigh, .colors = *named_color_map("viridis")};
    for (const Case& view : kCases) measure(view, rounds, look);
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "{}\n", wrong.what());
    return 1;
  }
  return 0;
}
