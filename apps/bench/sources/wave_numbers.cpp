#include "apps/bench/sources/wave_numbers.h"

#include <cmath>
#include <utility>

#include "tiles/painted_tiles.h"
#include "view/number_look.h"

namespace terrella::bench {
namespace {

constexpr TileGrid kWaveGrid{.tile_px = 256, .max_level = 7};

/// A number in [0, 255] for each texel of a tile.
std::vector<float> wave_texels(const TileId& id) {
  const TileBounds b = tile_bounds(kWaveGrid, id);
  const int side = kWaveGrid.tile_px;
  const double step = (b.east_deg - b.west_deg) / side;
  std::vector<float> texels;
  texels.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int k = 0; k < side * side; ++k) {
    const int column = k % side, row = k / side;
    const double around = (b.west_deg + (column + 0.5) * step) * M_PI / 180.0;
    const double north = (b.north_deg - (row + 0.5) * step) * M_PI / 180.0;
    const double wave = 60.0 * std::sin(37.0 * north) * std::cos(23.0 * around) +
                        60.0 * std::cos(5.0 * north) * std::sin(71.0 * around);
    texels.push_back(static_cast<float>(std::round(127.5 + wave)));
  }
  return texels;
}

class WaveNumbers : public TileSource {
 public:
  WaveNumbers(double low, double step, const NumberInfo& info) : low_(low), step_(step) {
    info_.grid = kWaveGrid;
    info_.format = ImageFormat::png;
    info_.numbers = info;
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(kWaveGrid, id)) return TileFailure{MissingKind::absent, "outside the grid"};
    EncodedTile tile;
    tile.make_numbers = [id, low = low_, step = step_]() -> Result<Numbers, TileFailure> {
      Numbers numbers{.width_px = kWaveGrid.tile_px, .height_px = kWaveGrid.tile_px, .values = wave_texels(id)};
      for (float& value : numbers.values) value = static_cast<float>(low + step * static_cast<double>(value));
      return numbers;
    };
    return tile;
  }

 private:
  double low_, step_;
  TileSetInfo info_;
};

}  // namespace

std::shared_ptr<TileSource> wave_numbers(double low, double step, const NumberInfo& info) {
  return std::make_shared<WaveNumbers>(low, step, info);
}

std::shared_ptr<TileSource> wave_pictures() {
  const NumberLook look{.low = 0.0, .high = 255.0, .colors = *named_color_map("viridis")};
  return painted_tiles(kWaveGrid, [look](const TileId& id) -> Result<Image, TileFailure> {
    Image image{kWaveGrid.tile_px, kWaveGrid.tile_px, {}};
    for (const float number : wave_texels(id)) {
      const Rgba8 c = color_of(look, static_cast<double>(number));
      image.rgba.insert(image.rgba.end(), {c.r, c.g, c.b, c.a});
    }
    return image;
  });
}

}  // namespace terrella::bench
