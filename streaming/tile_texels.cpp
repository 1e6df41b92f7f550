#include "streaming/tile_texels.h"

#include <fmt/format.h>

#include <cassert>
#include <cstring>

namespace terrella {
namespace {

constexpr std::size_t kChannels = 4;

/// Sums of 4^k texels a channel. Sixteen bits hold 4^4 texels of 255, which is why kMaxMips is 5.
using Sums = std::vector<std::uint16_t>;
static_assert((1U << (2 * (kMaxMips - 1))) * 255U <= 0xFFFFU);

template <class T>
Sums halve(const T* from, std::size_t from_side, std::size_t to_side) {
  Sums to(to_side * to_side * kChannels);
  for (std::size_t row = 0; row < to_side; ++row) {
    const T* upper = from + 2 * row * from_side * kChannels;
    const T* lower = upper + from_side * kChannels;
    std::uint16_t* out = to.data() + row * to_side * kChannels;
    for (std::size_t column = 0; column < to_side;
         ++column, upper += 2 * kChannels, lower += 2 * kChannels, out += kChannels) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        out[c] = static_cast<std::uint16_t>(upper[c] + upper[c + kChannels] + lower[c] + lower[c + kChannels]);
      }
    }
  }
  return to;
}

void fill_side(std::uint8_t* first, const std::uint8_t* texel, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) std::memcpy(first + i * kChannels, texel, kChannels);
}

/// Lays rows of `side` texels, made by write_row(row, target), into a square with a border of clamped texels.
template <class WriteRow>
std::vector<std::uint8_t> with_border(std::size_t side, std::size_t border, const WriteRow& write_row) {
  const std::size_t row_bytes = (side + 2 * border) * kChannels;
  std::vector<std::uint8_t> texels(row_bytes * (side + 2 * border));
  for (std::size_t row = 0; row < side; ++row) {
    std::uint8_t* line = texels.data() + (row + border) * row_bytes;
    std::uint8_t* inner = line + border * kChannels;
    write_row(row, inner);
    fill_side(line, inner, border);
    fill_side(inner + side * kChannels, inner + (side - 1) * kChannels, border);
  }
  std::uint8_t* first = texels.data() + border * row_bytes;
  std::uint8_t* last = first + (side - 1) * row_bytes;
  for (std::size_t i = 0; i < border; ++i) {
    std::memcpy(texels.data() + i * row_bytes, first, row_bytes);
    std::memcpy(last + (i + 1) * row_bytes, last, row_bytes);
  }
  return texels;
}

std::vector<std::uint8_t> finest_mip(const Image& tile, std::size_t side, std::size_t border) {
  return with_border(side, border, [&](std::size_t row, std::uint8_t* target) {
    std::memcpy(target, tile.rgba.data() + row * side * kChannels, side * kChannels);
  });
}

std::vector<std::uint8_t> mean_mip(const Sums& sums, std::size_t side, std::size_t border, int mip) {
  const int shift = 2 * mip;
  const std::uint32_t half = 1U << (shift - 1);
  return with_border(side, border, [&](std::size_t row, std::uint8_t* target) {
    const std::uint16_t* from = sums.data() + row * side * kChannels;
    for (std::size_t i = 0; i < side * kChannels; ++i) target[i] = static_cast<std::uint8_t>((from[i] + half) >> shift);
  });
}

}  // namespace

std::size_t size_bytes(const TileTexels& texels) {
  std::size_t bytes = 0;
  for (const auto& mip : texels.mips) bytes += mip.size();
  return bytes;
}

Result<TileTexels, TileFailure> make_texels(const Image& tile, int tile_px, int gutter, int mips) {
  assert(mips >= 1 && mips <= kMaxMips && gutter >= 0 && tile_px >> (mips - 1) >= 1);
  if (tile.width_px != tile_px || tile.height_px != tile_px) {
    return TileFailure{Absence::broken, fmt::format("the tile is {}×{} pixels, the tile set says {}×{}", tile.width_px,
                                                    tile.height_px, tile_px, tile_px)};
  }
  const auto side = static_cast<std::size_t>(tile_px);
  assert(tile.rgba.size() == side * side * kChannels);
  TileTexels texels{.tile_px = tile_px, .gutter = gutter, .mips = {}};
  texels.mips.push_back(finest_mip(tile, side, static_cast<std::size_t>(gutter)));
  Sums sums;
  for (int mip = 1; mip < mips; ++mip) {
    const std::size_t mip_side = side >> mip;
    sums = mip == 1 ? halve(tile.rgba.data(), side, mip_side) : halve(sums.data(), side >> (mip - 1), mip_side);
    texels.mips.push_back(mean_mip(sums, mip_side, static_cast<std::size_t>(gutter >> mip), mip));
  }
  return texels;
}

}  // namespace terrella
