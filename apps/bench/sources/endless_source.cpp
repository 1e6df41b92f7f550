#include "apps/bench/sources/endless_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "codecs/image.h"

namespace terrella::bench {
namespace {

constexpr int kTile_px = 256;
constexpr int kWaves = 19;           // one per level
constexpr double kAmplitude = 10.0;  // amplitude of each wave, in 8-bit levels

/// The waves of one axis over a tile: kWaves values per texel. Wave k belongs to the level k above; 48 of its periods
/// lie on a tile of that level, 5.3 texels each. A level has its own wave and the waves of all coarser levels.
std::vector<float> waves(int level, std::int64_t tile, double phase) {
  std::vector<float> values;
  for (int texel = 0; texel < kTile_px; ++texel) {
    const double tiles = static_cast<double>(tile) + (texel + 0.5) / kTile_px;
    for (int k = 0; k < kWaves; ++k) {
      const double turns = std::ldexp(tiles, -k) * 48.0;
      const double octave = level - k;
      const double angle = 2.0 * std::numbers::pi * (turns - std::floor(turns)) + octave * phase;
      values.push_back(octave < 0.0 ? 0.0F : static_cast<float>(std::sin(angle)));
    }
  }
  return values;
}

class EndlessSource : public TileSource {
 public:
  EndlessSource() {
    info_.name = "waves";
    info_.grid = {.root_span_deg = 180.0, .tile_px = kTile_px, .max_level = 18};
    info_.format = ImageFormat::png;
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the grid"};
    Image image{kTile_px, kTile_px, {}};
    image.rgba.reserve(4UL * kTile_px * kTile_px);
    const std::vector<float> east = waves(id.level, id.x, 1.0), south = waves(id.level, id.y, 2.0);
    for (std::size_t y = 0; y < kTile_px; ++y) {
      for (std::size_t x = 0; x < kTile_px; ++x) add_texel(&east[kWaves * x], &south[kWaves * y], image.rgba);
    }
    Result<std::vector<std::byte>> png = encode_png(image);
    if (!png) return TileFailure{MissingKind::broken, png.error().message};
    return EncodedTile{.bytes = *std::move(png)};
  }

 private:
  static void add_texel(const float* east, const float* south, std::vector<std::uint8_t>& rgba) {
    float sum = 0.0F, other = 0.0F;
    for (int k = 0; k < kWaves; ++k) {
      sum += east[k] * south[k];
      other += east[k] - south[k];
    }
    const auto level = [](float v) {
      return static_cast<std::uint8_t>(std::clamp(127.5 + kAmplitude * static_cast<double>(v), 0.0, 255.0));
    };
    rgba.insert(rgba.end(), {level(sum), level(0.5F * other), level(-sum), 255});
  }

  TileSetInfo info_;
};

}  // namespace

std::unique_ptr<TileSource> make_endless_source() { return std::make_unique<EndlessSource>(); }

}  // namespace terrella::bench
