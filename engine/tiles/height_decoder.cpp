#include "tiles/height_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "codecs/float_tiff.h"
#include "codecs/png_codec.h"
#include "tiles/height_gaps.h"

namespace terrella {
namespace {

TileFailure broken(const std::string& why) { return {MissingKind::broken, why}; }

/// metres = number · scale + offset, with the factors of tile and set combined.
struct Metres {
  double scale;
  double offset;
  std::optional<double> nodata;
};

/// The nodata of float tiles may be written with more digits than a float holds. A value beyond the range of floats
/// means nothing.
std::optional<double> nodata_of(const ElevationInfo& info) {
  if (!info.floats || !info.nodata) return info.nodata;
  if (std::abs(*info.nodata) > static_cast<double>(std::numeric_limits<float>::max())) return {};
  return static_cast<double>(static_cast<float>(*info.nodata));
}

Metres metres_of(const EncodedTile& tile, const ElevationInfo& info) {
  return {.scale = tile.number_scale * info.scale,
          .offset = tile.number_offset * info.scale + info.offset,
          .nodata = nodata_of(info)};
}

template <class Number>
Result<HeightTile, TileFailure> to_heights(HeightTile tile, const std::vector<Number>& numbers, const Metres& metres) {
  tile.heights_m.reserve(numbers.size());
  std::vector<std::uint8_t> is_known;
  is_known.reserve(numbers.size());
  for (const Number number : numbers) {
    const auto value = static_cast<double>(number);
    const double height_m = value * metres.scale + metres.offset;
    const bool known = value != metres.nodata && std::isfinite(height_m);
    if (!known) ++tile.unknown;
    if (known && std::abs(height_m) > kMaxHeight_m) {
      return broken(
          fmt::format("a height of {:.6g} m, beyond {:.0f} m: scale or offset is wrong", height_m, kMaxHeight_m));
    }
    tile.heights_m.push_back(known ? static_cast<float>(height_m) : 0.0F);
    is_known.push_back(known ? 1 : 0);
  }
  if (tile.unknown > 0) fill_gaps(tile.heights_m, std::move(is_known), tile.side_px);
  const auto [least, most] = std::ranges::minmax(tile.heights_m);
  tile.min_m = least;
  tile.max_m = most;
  return tile;
}

Result<HeightTile, TileFailure> from_png(HeightTile tile, const EncodedTile& encoded, const Metres& metres) {
  DecodeLimits limits;
  limits.max_side_px = std::max(tile.side_px, 1024);
  const Result<Gray16> gray = decode_gray16_png(encoded.bytes, limits);
  if (!gray) return broken(gray.error().message);
  if (gray->width_px != tile.side_px || gray->height_px != tile.side_px) {
    return broken(fmt::format("PNG: {}×{} pixels, the tile set says {}×{}", gray->width_px, gray->height_px,
                              tile.side_px, tile.side_px));
  }
  return to_heights(std::move(tile), gray->values, metres);
}

}  // namespace

Result<HeightTile, TileFailure> decode_heights(const TileId& id, const EncodedTile& tile, const ElevationInfo& info,
                                               int side_px) {
  HeightTile made{.id = id, .side_px = side_px, .heights_m = {}};
  const Metres metres = metres_of(tile, info);
  if (info.floats) {
    const auto numbers = decode_float_tiff(tile.bytes, side_px);
    if (!numbers) return broken(numbers.error().message);
    return to_heights(std::move(made), *numbers, metres);
  }
  if (const ImageFormat format = sniff_format(tile.bytes); format != ImageFormat::png) {
    return broken(
        fmt::format("{}, heights are PNG pictures, gray of 16 bits", format == ImageFormat::jpeg   ? "a JPEG picture"
                                                                     : format == ImageFormat::webp ? "a WebP picture"
                                                                                                   : "no PNG picture"));
  }
  return from_png(std::move(made), tile, metres);
}

}  // namespace terrella
