#include "mercator_planet.h"

#include <cmath>
#include <numbers>

namespace terrella::test {
namespace {

constexpr int kPlacesASide = 4;

double latitude_at(double down) {
  const double y = std::numbers::pi * (1.0 - 2.0 * down);
  return (2.0 * std::atan(std::exp(y)) - 0.5 * std::numbers::pi) * 180.0 / std::numbers::pi;
}

std::uint8_t to_level(double sum) {
  return static_cast<std::uint8_t>(std::lround(sum / (kPlacesASide * kPlacesASide)));
}

}  // namespace

Image mercator_tile(const Planet& planet, int tile_px, int level, std::int64_t x, std::int64_t y) {
  Image tile{tile_px, tile_px, {}};
  const double step = std::ldexp(1.0, -level) / tile_px / kPlacesASide;
  for (int j = 0; j < tile_px; ++j) {
    for (int i = 0; i < tile_px; ++i) {
      PlaceColor sum;
      for (int part = 0; part < kPlacesASide * kPlacesASide; ++part) {
        const double right = (static_cast<double>(x * tile_px + i) * kPlacesASide + part % kPlacesASide + 0.5) * step;
        const double down = (static_cast<double>(y * tile_px + j) * kPlacesASide + part / kPlacesASide + 0.5) * step;
        const PlaceColor color = planet(latitude_at(down), right * 360.0 - 180.0);
        sum = {sum.red + color.red, sum.green + color.green, sum.blue + color.blue};
      }
      tile.rgba.insert(tile.rgba.end(), {to_level(sum.red), to_level(sum.green), to_level(sum.blue), 255});
    }
  }
  return tile;
}

MercatorPlanet::MercatorPlanet(Planet planet, int tile_px, int max_level) : planet_(std::move(planet)) {
  info_.grid = {
      .root_span_deg = 360.0, .tile_px = tile_px, .max_level = max_level, .projection = Projection::web_mercator};
  info_.format = ImageFormat::png;
}

Result<EncodedTile, TileFailure> MercatorPlanet::read(const TileId& id) {
  {
    const std::lock_guard lock(mutex_);
    ++reads_[id];
  }
  if (const auto missing = missing_.find(id); missing != missing_.end()) {
    return TileFailure{missing->second, "the test says so"};
  }
  if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
  const auto given = given_.find(id);
  return EncodedTile{*encode_png(
      given != given_.end() ? given->second : mercator_tile(planet_, info_.grid.tile_px, id.level, id.x, id.y))};
}

std::map<TileId, int> MercatorPlanet::reads() {
  const std::lock_guard lock(mutex_);
  return reads_;
}

}  // namespace terrella::test
