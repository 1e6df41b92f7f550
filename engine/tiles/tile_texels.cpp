#include "tiles/tile_texels.h"

#include <fmt/format.h>

#include <cassert>
#include <cstring>

#include "tiles/texel_border.h"

namespace terrella {
namespace {

constexpr std::size_t kChannels = 4;

/// Sums of 4^k texels per channel, for an opaque tile. Sixteen bits hold the sum of 4^4 texels of 255, which is why
/// kMaxMips is 5.
using Sums = std::vector<std::uint16_t>;
static_assert((1U << (2 * (kMaxMips - 1))) * 255U <= 0xFFFFU);
/// The same for a tile with transparency: colour times alpha, and alpha.
using WeighedSums = std::vector<std::uint32_t>;
static_assert((1ULL << (2 * (kMaxMips - 1))) * 255U * 255U * 2U <= 0xFFFFFFFFU);

template <class Sum, class T>
std::vector<Sum> halve(const T* from, std::size_t from_side, std::size_t to_side) {
  std::vector<Sum> to(to_side * to_side * kChannels);
  for (std::size_t row = 0; row < to_side; ++row) {
    const T* upper = from + 2 * row * from_side * kChannels;
    const T* lower = upper + from_side * kChannels;
    Sum* out = to.data() + row * to_side * kChannels;
    for (std::size_t column = 0; column < to_side;
         ++column, upper += 2 * kChannels, lower += 2 * kChannels, out += kChannels) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        out[c] = static_cast<Sum>(upper[c] + upper[c + kChannels] + lower[c] + lower[c + kChannels]);
      }
    }
  }
  return to;
}

bool is_opaque(const Image& tile) {
  for (std::size_t i = 3; i < tile.rgba.size(); i += kChannels) {
    if (tile.rgba[i] != 255) return false;
  }
  return true;
}

WeighedSums weighed_by_alpha(const Image& tile) {
  WeighedSums weighed(tile.rgba.size());
  for (std::size_t i = 0; i < weighed.size(); i += kChannels) {
    const std::uint32_t alpha = tile.rgba[i + 3];
    for (std::size_t c = 0; c < 3; ++c) weighed[i + c] = tile.rgba[i + c] * alpha;
    weighed[i + 3] = alpha;
  }
  return weighed;
}

std::vector<std::uint8_t> finest_mip(const Image& tile, std::size_t side, std::size_t border) {
  return with_border<kChannels>(side, border, [&](std::size_t row, std::uint8_t* target) {
    std::memcpy(target, tile.rgba.data() + row * side * kChannels, side * kChannels);
  });
}

std::vector<std::uint8_t> mean_mip(const Sums& sums, std::size_t side, std::size_t border, int mip) {
  const int shift = 2 * mip;
  const std::uint32_t half = 1U << (shift - 1);
  return with_border<kChannels>(side, border, [&](std::size_t row, std::uint8_t* target) {
    const std::uint16_t* from = sums.data() + row * side * kChannels;
    for (std::size_t i = 0; i < side * kChannels; ++i) target[i] = static_cast<std::uint8_t>((from[i] + half) >> shift);
  });
}

std::vector<std::uint8_t> mean_mip(const WeighedSums& sums, std::size_t side, std::size_t border, int mip) {
  const int shift = 2 * mip;
  return with_border<kChannels>(side, border, [&](std::size_t row, std::uint8_t* target) {
    const std::uint32_t* from = sums.data() + row * side * kChannels;
    for (std::size_t i = 0; i < side * kChannels; i += kChannels) {
      const std::uint32_t alpha = from[i + 3];
      for (std::size_t c = 0; c < 3; ++c) {
        target[i + c] =
            alpha == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>((2 * from[i + c] + alpha) / (2 * alpha));
      }
      target[i + 3] = static_cast<std::uint8_t>((alpha + (1U << (shift - 1))) >> shift);
    }
  });
}

template <class AllSums, class T>
void append_means(const T* finest, std::size_t side, int mips, TileTexels& texels) {
  AllSums sums;
  for (int mip = 1; mip < mips; ++mip) {
    using Sum = typename AllSums::value_type;
    sums = mip == 1 ? halve<Sum>(finest, side, side >> mip) : halve<Sum>(sums.data(), side >> (mip - 1), side >> mip);
    texels.mips.push_back(mean_mip(sums, side >> mip, static_cast<std::size_t>(texels.gutter >> mip), mip));
  }
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
    return TileFailure{MissingKind::broken, fmt::format("the tile is {}×{} pixels, the tile set says {}×{}",
                                                        tile.width_px, tile.height_px, tile_px, tile_px)};
  }
  if (Status good = check_image(tile); !good) return TileFailure{MissingKind::broken, good.error().message};
  const auto side = static_cast<std::size_t>(tile_px);
  TileTexels texels{.tile_px = tile_px, .gutter = gutter, .opaque = is_opaque(tile), .mips = {}};
  texels.mips.push_back(finest_mip(tile, side, static_cast<std::size_t>(gutter)));
  if (texels.opaque) {
    append_means<Sums>(tile.rgba.data(), side, mips, texels);
  } else {
    append_means<WeighedSums>(weighed_by_alpha(tile).data(), side, mips, texels);
  }
  return texels;
}

void premultiply(TileTexels& texels) {
  if (texels.opaque) return;
  for (auto& mip : texels.mips) {
    for (std::size_t i = 0; i < mip.size(); i += kChannels) {
      const unsigned alpha = mip[i + 3];
      for (std::size_t c = 0; c < 3; ++c) mip[i + c] = static_cast<std::uint8_t>((mip[i + c] * alpha + 127U) / 255U);
    }
  }
}

}  // namespace terrella
