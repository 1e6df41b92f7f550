#include "painted_raster.h"

#include <proj.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace terrella::test {

Places::Places(const std::string& proj_string)
    : context_(proj_context_create()), path_(proj_create(context_, proj_string.c_str())) {
  proj_log_level(context_, PJ_LOG_NONE);
}
Places::~Places() {
  proj_destroy(path_);
  proj_context_destroy(context_);
}

Places::Place Places::of(double x, double y) const {
  const PJ_COORD to = proj_trans(path_, PJ_INV, proj_coord(x, y, 0.0, HUGE_VAL));
  constexpr double kToDeg = 180.0 / M_PI;
  return {to.lp.phi * kToDeg, to.lp.lam * kToDeg};
}

PaintedRaster::PaintedRaster(const PaintedOptions& options, Ground red, Ground green)
    : options_(options), red_(std::move(red)), green_(std::move(green)) {
  info_.crs = options.crs + " +type=crs";
  for (int k = options.overviews; k >= 0; --k) {
    const auto half = [k](std::int64_t size) { return (size + (1 << k) - 1) >> k; };
    RasterLevel level{.width_px = half(options.width_px),
                      .height_px = half(options.height_px),
                      .block_width_px = options.block_px,
                      .block_height_px = options.block_px,
                      .to_crs = options.to_crs};
    for (double* step :
         {&level.to_crs.x_per_column, &level.to_crs.x_per_row, &level.to_crs.y_per_column, &level.to_crs.y_per_row}) {
      *step *= std::ldexp(1.0, k);
    }
    info_.levels.push_back(level);
  }
  if (options.numbers) info_.numbers = NumberInfo{.floats = true};
}

Image PaintedRaster::paint(const TileId& block) const {
  const RasterLevel& level = info_.levels[static_cast<std::size_t>(block.level)];
  const Places places(options_.crs);
  const int rays = options_.rays << (info_.levels.size() - 1 - static_cast<std::size_t>(block.level));
  Image image{level.block_width_px, level.block_height_px, {}};
  for (int j = 0; j < image.height_px; ++j) {
    for (int i = 0; i < image.width_px; ++i) {
      double red = 0.0, green = 0.0;
      int placed = 0;
      for (int ray = 0; ray < rays * rays; ++ray) {
        const double column = static_cast<double>(block.x * level.block_width_px + i) + (ray % rays + 0.5) / rays;
        const double row = static_cast<double>(block.y * level.block_height_px + j) + (ray / rays + 0.5) / rays;
        const CrsPoint at = level.to_crs.at(column, row);
        const Places::Place place = places.of(at.x, at.y);
        if (!std::isfinite(place.lat_deg) || !std::isfinite(place.lon_deg)) continue;
        red += red_(place.lat_deg, place.lon_deg);
        green += green_(place.lat_deg, place.lon_deg);
        ++placed;
      }
      const auto byte = [&](double sum) {
        return placed == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(std::lround(sum / placed));
      };
      image.rgba.insert(image.rgba.end(),
                        {byte(red), byte(green), 40, static_cast<std::uint8_t>(placed > 0 ? 255 : 0)});
    }
  }
  return image;
}

Result<EncodedTile, TileFailure> PaintedRaster::read(const TileId& block) {
  {
    const std::lock_guard lock(mutex_);
    ++reads_[block];
  }
  if (const auto missing = missing_.find(block); missing != missing_.end()) {
    return TileFailure{missing->second, "the test says so"};
  }
  EncodedTile tile;
  if (!options_.numbers) {
    tile.make_picture = [this, block]() -> Result<Image, TileFailure> { return paint(block); };
    return tile;
  }
  tile.make_numbers = [this, block]() -> Result<Numbers, TileFailure> {
    const Image image = paint(block);
    Numbers numbers{image.width_px, image.height_px, {}};
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      numbers.values.push_back(image.rgba[i + 3] == 0 ? std::numeric_limits<float>::quiet_NaN()
                                                      : static_cast<float>(image.rgba[i]));
    }
    return numbers;
  };
  return tile;
}

std::map<TileId, int> PaintedRaster::reads() {
  const std::lock_guard lock(mutex_);
  return reads_;
}

}  // namespace terrella::test
