#include "streaming/remote/source_json.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "streaming/json_fields.h"
#include "streaming/projection_names.h"
#include "streaming/sets/elevation_json.h"
#include "tiles/grid_ranges.h"
#include "tiles/tile_grid.h"

namespace terrella {
namespace {

constexpr int kVersion = 1;
constexpr int kMaxLife_s = 315'360'000;  // ten years; more is a mistake of units

constexpr std::array kKnown = {"version",
                               "name",
                               "attribution",
                               "body",
                               "url",
                               "subdomains",
                               "headers",
                               "wmts",
                               "layer",
                               "matrix_set",
                               "style",
                               "time",
                               "tms",
                               "wms",
                               "min_level",
                               "max_level",
                               "root_span_deg",
                               "tile_px",
                               "bounds",
                               "format",
                               "latitude",
                               "projection",
                               "absence_life_s",
                               "tile_life_s",
                               "elevation",
                               "encoding",
                               "crs",
                               "extent",
                               "resolutions",
                               "tile_matrix_set",
                               "times"};

std::optional<std::string> text_if(JsonFields& fields, const char* field) {
  return fields.has(field) ? std::optional(fields.text(field)) : std::nullopt;
}

std::optional<int> integer_if(JsonFields& fields, const char* field, int least, int most) {
  if (!fields.has(field)) return std::nullopt;
  const int value = fields.integer(field, std::nullopt);
  if (value >= least && value <= most) return value;
  return fields.fail<int>(field, fmt::format("must be in [{}, {}]", least, most));
}

std::optional<std::chrono::seconds> life_if(JsonFields& fields, const char* field) {
  const auto life_s = integer_if(fields, field, 0, kMaxLife_s);
  return life_s ? std::optional(std::chrono::seconds(*life_s)) : std::nullopt;
}

std::optional<double> root_span_if(JsonFields& fields) {
  if (!fields.has("root_span_deg")) return std::nullopt;
  const double span = fields.number("root_span_deg");
  if (span >= kMinRootSpanDeg && span <= kMaxRootSpanDeg) return span;
  return fields.fail<double>("root_span_deg", fmt::format("must be in [{}, {}]", kMinRootSpanDeg, kMaxRootSpanDeg));
}

void read_grid(JsonFields& fields, RemoteOptions& options) {
  options.root_span_deg = root_span_if(fields);
  options.tile_px = integer_if(fields, "tile_px", kMinTilePx, kMaxTilePx);
  options.min_level = integer_if(fields, "min_level", 0, kMaxTileLevel);
  options.max_level = integer_if(fields, "max_level", 0, kMaxTileLevel);
  if (fields.has("bounds")) options.bounds = fields.bounds("bounds");
  if (fields.has("format")) options.format = static_cast<ImageFormat>(fields.choice("format", kImageFormatNames, 0));
  if (fields.has("projection")) {
    options.projection = static_cast<Projection>(fields.choice("projection", kProjectionNames, 0));
  }
  if (fields.has("latitude")) {
    const bool centric = fields.choice("latitude", "graphic", "centric", 0) == 1;
    options.latitude = centric ? LatitudeKind::centric : LatitudeKind::graphic;
  }
}

std::vector<double> numbers_of(const nlohmann::json& object, JsonFields& fields, const char* field, std::size_t most) {
  std::vector<double> numbers;
  if (!fields.has(field)) return numbers;
  const nlohmann::json& list = object[field];
  const bool fits = list.is_array() && !list.empty() && list.size() <= most;
  if (fits) numbers.reserve(list.size());
  for (std::size_t i = 0; fits && i < list.size(); ++i) {
    if (list[i].is_number()) numbers.push_back(list[i].get<double>());
  }
  if (fits && numbers.size() == list.size()) return numbers;
  return fields.fail<std::vector<double>>(field, fmt::format("must be a list of numbers, at most {}", most));
}

/// Reads the place of tiles in a coordinate system of their own.
void read_square(const nlohmann::json& object, JsonFields& fields, SourceDescription& source) {
  StatedSquare square{.crs = fields.text("crs")};
  const auto extent = numbers_of(object, fields, "extent", 4);
  if (extent.size() == 4) square.extent = CrsBounds{extent[0], extent[1], extent[2], extent[3]};
  const bool ordered = square.extent && extent[0] < extent[2] && extent[1] < extent[3];
  if (fields.has("extent") && !ordered)
    fields.fail<int>("extent", "must be [west, south, east, north] in units of crs");
  square.resolutions = numbers_of(object, fields, "resolutions", 64);
  for (std::size_t i = 0; i < square.resolutions.size(); ++i) {
    const bool finer = i == 0 || square.resolutions[i] < square.resolutions[i - 1];
    if (!(square.resolutions[i] > 0.0) || !finer) {
      fields.fail<int>("resolutions", "must be positive and descend: units of crs in a pixel of level 0, 1, …");
    }
  }
  if (fields.has("tile_matrix_set")) square.matrix_set_json = object["tile_matrix_set"].dump();
  const bool has_crs = !square.crs.empty();
  if (!has_crs && (square.extent || !square.resolutions.empty())) fields.fail<int>("extent", "needs a \"crs\"");
  if (has_crs && !square.matrix_set_json.empty()) fields.fail<int>("crs", "is that of the \"tile_matrix_set\"");
  if (!has_crs && square.matrix_set_json.empty()) return;
  if (has_crs && !square.extent) fields.fail<int>("crs", "needs an \"extent\"");
  if (source.kind != SourceDescription::Kind::url_template) fields.fail<int>("crs", "is for a \"url\" alone");
  source.options.square = std::move(square);
}

void read_kind(JsonFields& fields, SourceDescription& source) {
  using SourceKind = SourceDescription::Kind;
  constexpr std::array kKinds = {std::pair("url", SourceKind::url_template), std::pair("wmts", SourceKind::wmts),
                                 std::pair("wms", SourceKind::wms), std::pair("tms", SourceKind::tms)};
  int kinds = 0;
  for (const auto& [field, kind] : kKinds) {
    if (!fields.has(field)) continue;
    ++kinds;
    source.kind = kind;
    source.address = fields.text(field);
  }
  if (kinds != 1) {
    fields.fail<int>("url", kinds == 0
                                ? "is missing (or \"wmts\", or \"wms\", or \"tms\")"
                                : "cannot stand beside \"wmts\", \"wms\" or \"tms\": a source is one of the four");
    return;
  }
  const bool is_wmts = source.kind == SourceKind::wmts;
  if (fields.has("matrix_set") && !is_wmts) fields.fail<int>("matrix_set", "is for a \"wmts\" alone");
  if (fields.has("times") && source.kind != SourceKind::url_template) {
    fields.fail<int>("times", "is for a \"url\" alone; a service lists its own");
  }
  if (fields.has("time") && source.kind == SourceKind::tms) fields.fail<int>("time", "is not for a \"tms\"");
  for (const char* field : {"layer", "style"}) {
    if (fields.has(field) && !is_wmts && source.kind != SourceKind::wms) {
      fields.fail<int>(field, "is for a \"wmts\" or a \"wms\" alone");
    }
  }
}

}  // namespace

Result<SourceDescription> parse_source_json(std::string_view text, const std::string& where) {
  const Result<nlohmann::json> object = parse_json_object(text, kMaxSourceJsonBytes, where);
  if (!object) return object.error();
  JsonFields fields(*object, where);
  SourceDescription source;
  RemoteOptions& options = source.options;
  fields.refuse_others(kKnown);
  if (fields.integer("version", kVersion) != kVersion) fields.fail<int>("version", "must be 1");
  read_kind(fields, source);
  options.layer = fields.text("layer");
  options.matrix_set = fields.text("matrix_set");
  options.style = fields.text("style");
  options.time = fields.text("time");
  options.times = fields.texts("times");
  options.name = text_if(fields, "name");
  options.attribution = text_if(fields, "attribution");
  options.body = text_if(fields, "body");
  options.subdomains = fields.texts("subdomains");
  options.headers = fields.texts("headers");
  options.tile_life = life_if(fields, "tile_life_s");
  options.missing_life = life_if(fields, "absence_life_s");
  read_grid(fields, options);
  read_square(*object, fields, source);
  options.numbers = read_elevation(*object, fields, where);
  if (options.numbers && !options.numbers->rgb && options.format && options.format != ImageFormat::png) {
    fields.fail<int>("format", "must be \"png\" where there is an \"elevation\"");
  }
  if (fields.error()) return *fields.error();
  if (Status checked = check_options(options, where); !checked) return checked.error();
  if (options.bounds) {
    if (Status checked = check_grid(TileGrid{.bounds = *options.bounds}, where); !checked) return checked.error();
  }
  return source;
}

}  // namespace terrella
