#include "streaming/sets/gpkg_crs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geo/body.h"
#include "streaming/georeference/crs.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/georeference/figure.h"
#include "streaming/sets/gpkg_schema.h"

namespace terrella {
namespace {

/// Largest difference between a system's own numbers and degrees, a centimetre on the Earth.
constexpr double kSameDeg = 1e-7;

/// A row of gpkg_spatial_ref_sys.
struct SrsRow {
  std::string name;
  std::vector<std::string> texts;  ///< for stated_crs(), the best first
};

std::string column_of(SqliteReader& reader, const char* column, std::int64_t srs_id) {
  Result<SqliteQuery, SqlError> query =
      reader.prepare(fmt::format("SELECT {} FROM gpkg_spatial_ref_sys WHERE srs_id = ?1", column));
  if (!query) return {};
  query->bind(1, srs_id);
  const Result<bool, SqlError> row = query->step();
  return row && *row ? query->text(0).value_or("") : std::string();
}

SrsRow read_row(SqliteReader& reader, std::int64_t srs_id) {
  SrsRow row{.name = fmt::format("srs_id {}", srs_id), .texts = {}};
  std::string code = column_of(reader, "upper(organization) || ':' || organization_coordsys_id", srs_id);
  const bool has_code = !code.empty() && !code.starts_with("NONE:") && !code.starts_with(':');
  if (has_code) {
    row.name = code.substr(0, 100);
    row.texts.push_back(std::move(code));
  }
  for (const char* column : {"definition", "definition_12_063"}) {
    std::string wkt = wkt_only(column_of(reader, column, srs_id));
    if (!wkt.empty()) row.texts.push_back(std::move(wkt));
  }
  return row;
}

/// True if the system's numbers are longitudes and latitudes in degrees at the corners of the extent.
bool counts_degrees(const Crs& crs, const CrsBounds& extent) {
  if (!crs.facts().geographic || !(std::max(std::abs(extent.west), std::abs(extent.east)) <= 720.0)) return false;
  const auto on_planet = [](double latitude) { return std::clamp(latitude, -89.0, 89.0); };
  std::vector<CrsPoint> points;
  for (const double x : {extent.west, 0.5 * (extent.west + extent.east), extent.east}) {
    for (const double y : {on_planet(extent.south), on_planet(extent.north)}) points.push_back({x, y});
  }
  const auto places = crs.places(points);
  if (!places) return false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CrsPoint& place = (*places)[i];
    const double turned = std::remainder(place.x - points[i].x, 360.0);
    if (!(std::abs(turned) <= kSameDeg && std::abs(place.y - points[i].y) <= kSameDeg)) return false;
  }
  return true;
}

GpkgCrs placed_crs(const Crs& crs, const std::string& name, const std::string& text, const CrsBounds& extent) {
  GpkgCrs found{
      .name = name, .projection = Projection::projected, .text = text, .body = body_name(crs.facts()), .latitude = {}};
  if (!counts_degrees(crs, extent)) return found;
  found.projection = Projection::equirectangular;
  if (const auto body = parse_body(found.body)) found.latitude = latitude_of(crs.facts(), *body);
  return found;
}

}  // namespace

Result<GpkgCrs> read_gpkg_crs(SqliteReader& reader, std::int64_t srs_id, const CrsBounds& extent, bool is_coverage) {
  const SrsRow row = read_row(reader, srs_id);
  const auto is_epsg = [&](int code) { return srs_id == code || row.name == fmt::format("EPSG:{}", code); };
  if (is_epsg(kSrsGeodetic)) return GpkgCrs{.name = "EPSG:4326"};
  if (is_epsg(kSrsWebMercator) && !is_coverage) {
    return GpkgCrs{.name = "EPSG:3857", .projection = Projection::web_mercator};
  }
  std::string why = "gpkg_spatial_ref_sys gives it no known code and no WKT";
  for (const std::string& said : row.texts) {
    const Result<std::string> text = stated_crs(said);
    const Result<Crs> crs = text ? Crs::open(*text) : Result<Crs>(text.error());
    if (crs) return placed_crs(*crs, row.name, *text, extent);
    why = crs.error().message;
  }
  return Error{fmt::format("in {}: {}. Write it again with `gdal_translate -of GPKG -a_srs EPSG:CODE`", row.name, why)};
}

}  // namespace terrella
