#include "streaming/remote/wmts/matrix_set_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "streaming/json_fields.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxSetBytes = 1UL << 20;
constexpr std::size_t kMaxJsonMatrices = 64;

/// The first of two fields that exists: the names of the two versions.
const json* field_of(const json& object, const char* name, const char* other) {
  for (const char* one : {name, other}) {
    const auto found = object.find(one);
    if (found != object.end() && !found->is_null()) return &*found;
  }
  return nullptr;
}

std::string text_in(const json& object, const char* name, const char* other) {
  const json* value = field_of(object, name, other);
  return value != nullptr && value->is_string() ? value->get<std::string>().substr(0, 256) : std::string();
}

std::optional<double> number_in_json(const json& object, const char* name, double least, double most) {
  const json* value = field_of(object, name, name);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  const double number = value->get<double>();
  return number >= least && number <= most ? std::optional(number) : std::nullopt;
}

std::optional<std::int64_t> whole_in_json(const json& object, const char* name, double most) {
  const auto number = number_in_json(object, name, 1.0, most);
  return number && *number == std::floor(*number) ? std::optional(static_cast<std::int64_t>(*number)) : std::nullopt;
}

std::string crs_of_json(const json& set) {
  const json* crs = field_of(set, "crs", "supportedCRS");
  if (crs == nullptr) return {};
  if (crs->is_string()) return crs->get<std::string>();
  return crs->is_object() ? text_in(*crs, "uri", "wkt") : std::string();
}

/// The reason why a matrix has no place in a grid; empty if it has one.
std::string fault_of_kind(const json& matrix) {
  const json* widths = field_of(matrix, "variableMatrixWidths", "variableMatrixWidth");
  if (widths != nullptr && !widths->empty()) {
    return "its rows have variable widths (variableMatrixWidths), which cannot be drawn";
  }
  const std::string corner = text_in(matrix, "cornerOfOrigin", "cornerOfOrigin");
  return corner == "bottomLeft" ? "its rows begin at the bottom (cornerOfOrigin), which cannot be drawn" : "";
}

Result<WmtsMatrix> read_json_matrix(const json& from) {
  WmtsMatrix matrix{.name = text_in(from, "id", "identifier")};
  const auto fault = [&](const std::string& what) {
    return Error{fmt::format("matrix \"{}\": {}", matrix.name, what)};
  };
  if (matrix.name.empty()) return Error{"a matrix has no id"};
  if (const std::string why = fault_of_kind(from); !why.empty()) return fault(why);
  constexpr double kMostScale = 1e15;
  const auto scale = number_in_json(from, "scaleDenominator", 0.0, kMostScale);
  if (!scale || *scale <= 0.0) return fault("scaleDenominator is not a positive number");
  const json* corner = field_of(from, "pointOfOrigin", "topLeftCorner");
  const bool is_pair = corner != nullptr && corner->is_array() && corner->size() == 2 && (*corner)[0].is_number() &&
                       (*corner)[1].is_number();
  if (!is_pair) return fault("pointOfOrigin is not two numbers");
  const auto width = whole_in_json(from, "tileWidth", kMaxTilePx);
  if (!width || *width < kMinTilePx || width != whole_in_json(from, "tileHeight", kMaxTilePx)) {
    return fault(fmt::format("tileWidth and tileHeight are not the same number in [{}, {}]", kMinTilePx, kMaxTilePx));
  }
  const auto columns = whole_in_json(from, "matrixWidth", kMaxTilesASide);
  const auto rows = whole_in_json(from, "matrixHeight", kMaxTilesASide);
  if (!columns || !rows) return fault("matrixWidth or matrixHeight is not a positive whole number");
  matrix.scale_denominator = *scale;
  matrix.corner = {(*corner)[0].get<double>(), (*corner)[1].get<double>()};
  matrix.tile_px = static_cast<int>(*width);
  matrix.columns = *columns;
  matrix.rows = *rows;
  return matrix;
}

}  // namespace

Result<WmtsMatrixSet> read_matrix_set_json(const std::string& text) {
  const Result<json> object = parse_json_object(text, kMaxSetBytes, "it");
  if (!object) return object.error();
  WmtsMatrixSet set{
      .name = text_in(*object, "id", "identifier"), .crs = crs_of_json(*object), .matrices = {}, .box = {}};
  const json* list = field_of(*object, "tileMatrices", "tileMatrix");
  if (list == nullptr || !list->is_array() || list->empty()) return Error{"it has no tileMatrices"};
  if (list->size() > kMaxJsonMatrices) return Error{fmt::format("more than {} matrices", kMaxJsonMatrices)};
  set.matrices.reserve(list->size());
  for (const json& one : *list) {
    if (!one.is_object()) return Error{"a matrix is no object"};
    Result<WmtsMatrix> matrix = read_json_matrix(one);
    if (!matrix) return Error{fmt::format("\"{}\": {}", set.name, matrix.error().message)};
    set.matrices.push_back(*std::move(matrix));
  }
  std::ranges::sort(set.matrices,
                    [](const WmtsMatrix& a, const WmtsMatrix& b) { return a.scale_denominator > b.scale_denominator; });
  return set;
}

}  // namespace terrella
