#include "streaming/pmtiles/tile_number.h"

#include <cassert>
#include <utility>

namespace terrella {
namespace {

/// Turns the quadrant of `side` tiles so that the curve within it begins where the curve enters it.
void turn(std::uint64_t side, std::uint64_t& x, std::uint64_t& y, bool right, bool lower) {
  if (lower) return;
  if (right) {
    x = side - 1 - x;
    y = side - 1 - y;
  }
  std::swap(x, y);
}

}  // namespace

std::uint64_t first_number(int level) {
  assert(level >= 0 && level <= kMaxTileLevel + 1);
  return ((std::uint64_t{1} << (2 * level)) - 1) / 3;
}

std::uint64_t tile_number(const TileId& id) {
  const std::uint64_t side = std::uint64_t{1} << id.level;
  auto x = static_cast<std::uint64_t>(id.x), y = static_cast<std::uint64_t>(id.y);
  assert(x < side && y < side);
  std::uint64_t along = 0;
  for (std::uint64_t half = side / 2; half > 0; half /= 2) {
    const bool right = (x & half) != 0, lower = (y & half) != 0;
    along += half * half * ((right ? 3U : 0U) ^ (lower ? 1U : 0U));
    x &= half - 1;
    y &= half - 1;
    turn(half, x, y, right, lower);
  }
  return first_number(id.level) + along;
}

TileId tile_of_number(std::uint64_t number) {
  int level = 0;
  while (first_number(level + 1) <= number) ++level;
  std::uint64_t along = number - first_number(level);
  std::uint64_t x = 0, y = 0;
  for (std::uint64_t half = 1; half < std::uint64_t{1} << level; half *= 2) {
    const bool right = (along & 2) != 0, lower = ((along ^ (along >> 1)) & 1) != 0;
    turn(half, x, y, right, lower);
    x += right ? half : 0;
    y += lower ? half : 0;
    along /= 4;
  }
  return {.level = level, .x = static_cast<std::int64_t>(x), .y = static_cast<std::int64_t>(y)};
}

}  // namespace terrella
