#include "streaming/remote/wmts/wmts_matrix_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "streaming/remote/wmts/xml_names.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

/// Reads a whole number that may be written as 2.0, as servers of NASA's do.
std::optional<std::int64_t> to_whole(std::string_view text) {
  const auto number = to_number(text);
  constexpr double kMost = 9.0e15;
  if (!number || *number != std::floor(*number) || std::abs(*number) > kMost) return std::nullopt;
  return static_cast<std::int64_t>(*number);
}

constexpr std::size_t kMaxMatrices = 64;
constexpr std::size_t kMaxNameBytes = 256;
constexpr auto kMaxMatrixTiles = static_cast<std::int64_t>(kMaxTilesASide);

bool in_range(const std::optional<std::int64_t>& value, std::int64_t low, std::int64_t high) {
  return value && *value >= low && *value <= high;
}

Result<WmtsMatrix> read_matrix(const pugi::xml_node& node) {
  WmtsMatrix matrix{.name = std::string(text_of(node, "Identifier"))};
  if (matrix.name.empty() || matrix.name.size() > kMaxNameBytes) {
    return Error{fmt::format("a TileMatrix has no Identifier, or one over {} bytes", kMaxNameBytes)};
  }
  const auto fault = [&](const std::string& what) {
    return Error{fmt::format("TileMatrix \"{}\": {}", matrix.name, what)};
  };
  const auto scale = to_number(text_of(node, "ScaleDenominator"));
  if (!scale || *scale <= 0.0) return fault("ScaleDenominator is not a positive number");
  const auto corner = to_pair(text_of(node, "TopLeftCorner"));
  if (!corner) return fault("TopLeftCorner is not two numbers");
  const auto width = to_integer(text_of(node, "TileWidth"));
  if (!in_range(width, kMinTilePx, kMaxTilePx) || width != to_integer(text_of(node, "TileHeight"))) {
    return fault(fmt::format("TileWidth and TileHeight are not the same number in [{}, {}]", kMinTilePx, kMaxTilePx));
  }
  const auto columns = to_whole(text_of(node, "MatrixWidth"));
  const auto rows = to_whole(text_of(node, "MatrixHeight"));
  if (!in_range(columns, 1, kMaxMatrixTiles) || !in_range(rows, 1, kMaxMatrixTiles)) {
    return fault("MatrixWidth or MatrixHeight is not a positive whole number");
  }
  matrix.scale_denominator = *scale;
  matrix.corner = *corner;
  matrix.tile_px = static_cast<int>(*width);
  matrix.columns = *columns;
  matrix.rows = *rows;
  return matrix;
}

std::optional<WmtsBox> read_box(const pugi::xml_node& node) {
  const pugi::xml_node box = child_of(node, "BoundingBox");
  const auto low = to_pair(text_of(box, "LowerCorner"));
  const auto high = to_pair(text_of(box, "UpperCorner"));
  return low && high ? std::optional(WmtsBox{*low, *high}) : std::nullopt;
}

}  // namespace

const WmtsLimits* limits_of(const std::vector<WmtsLimits>& limits, const std::string& matrix) {
  auto found = std::ranges::find(limits, matrix, &WmtsLimits::matrix);
  if (found == limits.end()) {
    found = std::ranges::find_if(limits, [&](const WmtsLimits& one) { return one.matrix.ends_with(":" + matrix); });
  }
  return found == limits.end() ? nullptr : &*found;
}

Result<WmtsMatrixSet> read_matrix_set(const pugi::xml_node& node) {
  WmtsMatrixSet set{.name = std::string(text_of(node, "Identifier")),
                    .crs = std::string(text_of(node, "SupportedCRS")),
                    .matrices = {},
                    .box = {}};
  set.box = read_box(node);
  for (const pugi::xml_node& matrix : children_of(node, "TileMatrix")) {
    if (set.matrices.size() == kMaxMatrices) return Error{fmt::format("more than {} matrices", kMaxMatrices)};
    Result<WmtsMatrix> read = read_matrix(matrix);
    if (!read) return read.error();
    set.matrices.push_back(*std::move(read));
  }
  if (set.matrices.empty()) return Error{"it has no TileMatrix"};
  std::ranges::sort(set.matrices,
                    [](const WmtsMatrix& a, const WmtsMatrix& b) { return a.scale_denominator > b.scale_denominator; });
  return set;
}

std::vector<WmtsLimits> read_limits(const pugi::xml_node& link) {
  std::vector<WmtsLimits> all;
  for (const pugi::xml_node& node : children_of(child_of(link, "TileMatrixSetLimits"), "TileMatrixLimits")) {
    const auto first_row = to_integer(text_of(node, "MinTileRow"));
    const auto last_row = to_integer(text_of(node, "MaxTileRow"));
    const auto first_column = to_integer(text_of(node, "MinTileCol"));
    const auto last_column = to_integer(text_of(node, "MaxTileCol"));
    if (!in_range(first_row, 0, kMaxMatrixTiles) || !in_range(last_row, first_row.value_or(0), kMaxMatrixTiles))
      continue;
    if (!in_range(first_column, 0, kMaxMatrixTiles) ||
        !in_range(last_column, first_column.value_or(0), kMaxMatrixTiles))
      continue;
    if (all.size() == kMaxMatrices) break;
    all.push_back({.matrix = std::string(text_of(node, "TileMatrix")),
                   .first_column = *first_column,
                   .last_column = *last_column,
                   .first_row = *first_row,
                   .last_row = *last_row});
  }
  return all;
}

}  // namespace terrella
