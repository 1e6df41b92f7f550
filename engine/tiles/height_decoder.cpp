#include "tiles/height_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "codecs/float_tiff.h"
#include "codecs/png_codec.h"

namespace terrella {
namespace {

constexpr int kMostReach_px = 64;

template <class Visit>
void visit_neighbours(std::size_t at, std::size_t side, Visit visit) {
  if (at % side > 0) visit(at - 1);
  if (at % side + 1 < side) visit(at + 1);
  if (at >= side) visit(at - side);
  if (at + side < side * side) visit(at + side);
}

/// Fills unknown heights (0 in `known`) from the heights around them, so that a hole in the data makes neither a pit
/// nor a spike. Works inwards pixel by pixel: each gets the mean of its known neighbours. The values fall evenly to 0,
/// the data's zero level, over min(64, side / 4) pixels. Both arrays are side_px · side_px, row-major.
void fill_gaps(std::vector<float>& heights_m, std::vector<std::uint8_t> known, int side_px) {
  const auto side = static_cast<std::size_t>(side_px);
  std::vector<std::size_t> rim;
  for (std::size_t at = 0; at < known.size(); ++at) {
    if (known[at] == 0) continue;
    visit_neighbours(at, side, [&](std::size_t beside) {
      if (known[beside] == 0) rim.push_back(beside);
    });
  }
  const int reach = std::min(kMostReach_px, side_px / 4);
  for (int round = 1; round < reach && !rim.empty(); ++round) {
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    const float kept = static_cast<float>(reach - round) / static_cast<float>(reach - round + 1);
    for (const std::size_t at : rim) {
      float sum_m = 0.0F, count = 0.0F;
      visit_neighbours(at, side, [&](std::size_t beside) {
        if (known[beside] == 0) return;
        sum_m += heights_m[beside];
        count += 1.0F;
      });
      heights_m[at] = kept * sum_m / count;
    }
    std::vector<std::size_t> next;
    for (const std::size_t at : rim) known[at] = 1;
    for (const std::size_t at : rim) {
      visit_neighbours(at, side, [&](std::size_t beside) {
        if (known[beside] == 0) next.push_back(beside);
      });
    }
    rim = std::move(next);
  }
}

TileFailure broken(const std::string& why) { return {MissingKind::broken, why}; }

/// The nodata of float tiles may be written with more digits than a float holds. A value beyond the range of floats
/// means nothing.
std::optional<double> nodata_of(const NumberInfo& info) {
  if (!info.floats || !info.nodata) return info.nodata;
  if (std::abs(*info.nodata) > static_cast<double>(std::numeric_limits<float>::max())) return {};
  return static_cast<double>(static_cast<float>(*info.nodata));
}

Result<Numbers, TileFailure> from_png(const EncodedTile& encoded, int side_px, bool is_signed) {
  if (const ImageFormat format = sniff_format(encoded.bytes); format != ImageFormat::png) {
    return broken(
        fmt::format("{}, heights are PNG pictures, gray of 16 bits", format == ImageFormat::jpeg   ? "a JPEG picture"
                                                                     : format == ImageFormat::webp ? "a WebP picture"
                                                                                                   : "no PNG picture"));
  }
  DecodeLimits limits;
  limits.max_side_px = std::max(side_px, 1024);
  const Result<Gray16> gray = decode_gray16_png(encoded.bytes, limits);
  if (!gray) return broken(gray.error().message);
  Numbers numbers{gray->width_px, gray->height_px, {}};
  const auto number = [is_signed](std::uint16_t bits) {
    return is_signed ? static_cast<float>(static_cast<std::int16_t>(bits)) : static_cast<float>(bits);
  };
  std::ranges::transform(gray->values, std::back_inserter(numbers.values), number);
  return numbers;
}

Result<Numbers, TileFailure> from_colours(const EncodedTile& encoded, int side_px) {
  if (sniff_format(encoded.bytes) == ImageFormat::jpeg) {
    return broken("a JPEG picture, whose colours are not exact; heights in colours are PNG or lossless WebP");
  }
  DecodeLimits limits;
  limits.max_side_px = std::max(side_px, 1024);
  const Result<Image> image = decode_image(encoded.bytes, limits);
  if (!image) return broken(image.error().message);
  Numbers numbers{image->width_px, image->height_px, std::vector<float>(image->rgba.size() / 4)};
  for (std::size_t i = 0; i < numbers.values.size(); ++i) {
    const std::uint8_t* pixel = image->rgba.data() + 4 * i;
    // 24 bits are as many as a float has.
    numbers.values[i] = pixel[3] == 0 ? std::numeric_limits<float>::quiet_NaN()
                                      : static_cast<float>(pixel[0] * 65536 + pixel[1] * 256 + pixel[2]);
  }
  return numbers;
}

Result<Numbers, TileFailure> from_tiff(const EncodedTile& encoded, int side_px) {
  auto values = decode_float_tiff(encoded.bytes, side_px);
  if (!values) return broken(values.error().message);
  return Numbers{side_px, side_px, *std::move(values)};
}

/// metres = number · scale + offset, with the factors of tile and set combined.
Result<HeightTile, TileFailure> to_heights(HeightTile tile, const Numbers& numbers, double scale, double offset) {
  tile.heights_m.reserve(numbers.values.size());
  std::vector<std::uint8_t> is_known;
  is_known.reserve(numbers.values.size());
  for (const float number : numbers.values) {
    const double height_m = static_cast<double>(number) * scale + offset;
    const bool known = std::isfinite(height_m);
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

}  // namespace

Result<Numbers, TileFailure> decode_numbers(const EncodedTile& tile, const NumberInfo& info, int side_px) {
  auto numbers = tile.make_numbers ? tile.make_numbers()
                 : info.rgb        ? from_colours(tile, side_px)
                 : info.floats     ? from_tiff(tile, side_px)
                                   : from_png(tile, side_px, info.is_signed);
  if (!numbers) return numbers;
  if (numbers->width_px != side_px || numbers->height_px != side_px) {
    return broken(fmt::format("PNG: {}×{} pixels, the tile set says {}×{}", numbers->width_px, numbers->height_px,
                              side_px, side_px));
  }
  if (const std::size_t count = static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px);
      numbers->values.size() != count) {
    return broken(fmt::format("{0}×{0} pixels with {1} numbers, not {2}", side_px, numbers->values.size(), count));
  }
  const std::optional<double> nodata = nodata_of(info);
  for (float& number : numbers->values) {
    if (static_cast<double>(number) == nodata || !std::isfinite(number)) {
      number = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return numbers;
}

Result<HeightTile, TileFailure> decode_heights(const TileId& id, const EncodedTile& tile, const NumberInfo& info,
                                               int side_px) {
  const auto numbers = decode_numbers(tile, info, side_px);
  if (!numbers) return numbers.error();
  return to_heights({.id = id, .side_px = side_px, .heights_m = {}}, *numbers, tile.number_scale * info.scale,
                    tile.number_offset * info.scale + info.offset);
}

}  // namespace terrella
