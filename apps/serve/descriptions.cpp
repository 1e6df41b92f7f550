#include "apps/serve/descriptions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "apps/process/console.h"
#include "geo/body.h"
#include "streaming/convert/web_tiles.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/georeference/figure.h"
#include "streaming/remote/crs_names.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/remote/wmts/wmts_projected.h"
#include "streaming/sets/gpkg_schema.h"
#include "streaming/sets/tileset_json.h"
#include "streaming/warp/web_mercator.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

using nlohmann::ordered_json;

/// Text for XML and HTML.
std::string markup(std::string_view text) {
  std::string safe;
  for (const char c : one_line(text)) {
    constexpr std::string_view kMarks = "&<>\"";
    constexpr std::array kNames = {"&amp;", "&lt;", "&gt;", "&quot;"};
    const std::size_t mark = kMarks.find(c);
    if (mark == kMarks.npos) {
      safe += c;
    } else {
      safe += kNames.at(mark);
    }
  }
  return safe;
}

std::string title_of(const ServedSet& set) { return set.info().name.empty() ? set.name : set.info().name; }

/// A sentence for people about tiles that are numbers, which other programs take for pictures; empty for pictures.
std::string note_of(const TileSetInfo& info) {
  if (!info.numbers) return {};
  const NumberInfo& numbers = *info.numbers;
  const char* kind = "16-bit gray";
  if (numbers.is_signed) kind = "signed 16-bit gray";
  if (numbers.rgb) kind = "R * 65536 + G * 256 + B";
  if (numbers.floats) kind = "32-bit float";
  std::string note =
      fmt::format("The tiles are numbers, not pictures: {} = {} * ({}) + {}",
                  numbers.quantity.empty() ? "value" : numbers.quantity, numbers.scale, kind, numbers.offset);
  if (!numbers.unit.empty()) note += ", in " + numbers.unit;
  if (numbers.nodata) note += fmt::format("; {} is no data", *numbers.nodata);
  return note;
}

bool is_of_earth(const TileSetInfo& info) {
  const auto body = info.body.empty() ? Result<Body>(earth()) : parse_body(info.body);
  return body && !are_two_bodies(*body, earth());
}

/// Area in degrees, without a crossing of ±180°. None if it is unknown.
std::optional<GeoRect> plain_bounds(const TileSetInfo& info) {
  if (info.grid.projection == Projection::web_mercator) return web_bounds(info.grid);
  const auto drawn = drawn_grid_of(info);
  if (!drawn) return {};
  GeoRect bounds = drawn->bounds;
  if (bounds.east < bounds.west) std::tie(bounds.west, bounds.east) = std::pair(GeoRect{}.west, GeoRect{}.east);
  return bounds;
}

std::string dump(const ordered_json& document) {
  return document.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

/// The coordinate reference system of a matrix set.
struct MatrixSystem {
  std::string urn;
  double unit_m = 1.0;  ///< metres in a unit, as scale denominators count them
  bool northing_first = false;
};

/// The error is the reason alone.
Result<MatrixSystem> projected_system(const std::string& text) {
  const auto identity = identify_crs(text);
  if (!identity) return identity.error();
  if (identity->code == 0) return Error{"its coordinate reference system has no code"};
  const auto crs = Crs::open(text);
  if (!crs) return crs.error();
  const auto northing_first = is_northing_first(text);
  const std::string authority = identity->authority == "IAU_2015" ? "IAU:2015" : identity->authority + ":";
  return MatrixSystem{.urn = fmt::format("urn:ogc:def:crs:{}:{}", authority, identity->code),
                      .unit_m = metres_of_axis(crs->facts()),
                      .northing_first = northing_first && *northing_first};
}

Result<MatrixSystem> system_of(const TileSetInfo& info) {
  switch (info.grid.projection) {
    case Projection::web_mercator:
      if (!is_of_earth(info)) return Error{"its body is not the Earth, the only one with a registered Web Mercator"};
      return MatrixSystem{.urn = "urn:ogc:def:crs:EPSG::3857"};
    case Projection::projected:
      return projected_system(info.square->crs);
    case Projection::equal_area:
      return Error{"its rows are linear in the sine of latitude, which no registered system is"};
    case Projection::equirectangular:
      break;
  }
  std::string urn = geographic_crs_urn(info.body, info.grid.latitude);
  if (urn.empty()) return Error{"no system of coordinates is registered for its body"};
  return MatrixSystem{.urn = std::move(urn), .unit_m = kMercatorDegree_m};
}

std::string matrix_xml(const TileSetInfo& info, int level, const MatrixSystem& system) {
  const TileGrid& grid = info.grid;
  const GridUnits units = units_of(grid.projection, info.square);
  const bool placed = grid.projection == Projection::equirectangular;
  double east = units.x(placed ? grid.west_deg : -180.0), north = units.y(top_row_deg(grid));
  double unit_per_px = units.per_deg * tile_span_deg(grid, level) / grid.tile_px;
  if (info.square && !info.square->levels.empty()) {
    const CrsLevel& own = info.square->levels.at(static_cast<std::size_t>(level));
    std::tie(east, north, unit_per_px) = std::tuple(own.west, own.north, own.unit_per_px);
  }
  const MatrixSize size = matrix_size(info, level);
  if (system.northing_first) std::swap(east, north);
  return fmt::format(
      "<TileMatrix><ows:Identifier>{}</ows:Identifier><ScaleDenominator>{}</ScaleDenominator>"
      "<TopLeftCorner>{} {}</TopLeftCorner><TileWidth>{}</TileWidth><TileHeight>{}</TileHeight>"
      "<MatrixWidth>{}</MatrixWidth><MatrixHeight>{}</MatrixHeight></TileMatrix>\n",
      level + first_zoom(info), unit_per_px * system.unit_m / kOgcPixel_m, east, north, grid.tile_px, grid.tile_px,
      size.columns, size.rows);
}

std::string layer_xml(const ServedSet& set, std::string_view base) {
  const char* type = media_type(set.info());
  std::string head = fmt::format("<ows:Title>{}</ows:Title>", markup(title_of(set)));
  const std::string note = note_of(set.info());
  if (!note.empty()) head += fmt::format("<ows:Abstract>{}</ows:Abstract>", markup(note));
  if (const auto bounds = plain_bounds(set.info())) {
    head += fmt::format(
        "<ows:WGS84BoundingBox><ows:LowerCorner>{} {}</ows:LowerCorner>"
        "<ows:UpperCorner>{} {}</ows:UpperCorner></ows:WGS84BoundingBox>",
        tidy_degrees(bounds->west), tidy_degrees(bounds->south), tidy_degrees(bounds->east),
        tidy_degrees(bounds->north));
  }
  return fmt::format(
      "<Layer>{}<ows:Identifier>{}</ows:Identifier>\n"
      "<Style isDefault=\"true\"><ows:Identifier>default</ows:Identifier></Style><Format>{}</Format>"
      "<TileMatrixSetLink><TileMatrixSet>{}</TileMatrixSet></TileMatrixSetLink>\n"
      "<ResourceURL format=\"{}\" resourceType=\"tile\" "
      "template=\"{}/{}/wmts/{{TileMatrixSet}}/{{TileMatrix}}/{{TileRow}}/{{TileCol}}.{}\"/></Layer>\n",
      head, set.name, type, set.name, type, markup(base), set.name, tile_ending(set.info()));
}

std::string matrix_set_xml(const ServedSet& set, const MatrixSystem& system) {
  std::string xml =
      fmt::format("<TileMatrixSet><ows:Identifier>{}</ows:Identifier><ows:SupportedCRS>{}</ows:SupportedCRS>\n",
                  set.name, system.urn);
  for (int level = set.info().grid.min_level; level <= set.info().grid.max_level; ++level) {
    xml += matrix_xml(set.info(), level, system);
  }
  return xml + "</TileMatrixSet>\n";
}

/// The attributions of all sets, each once.
std::string attributions(std::span<const ServedSet> sets) {
  std::vector<std::string> known;
  std::string all;
  for (const ServedSet& set : sets) {
    const std::string& text = set.info().attribution;
    if (text.empty() || std::ranges::find(known, text) != known.end()) continue;
    known.push_back(text);
    all += (all.empty() ? "" : "; ") + text;
  }
  return all;
}

std::string operation_xml(const char* name, std::string_view base) {
  return fmt::format(
      "<ows:Operation name=\"{}\"><ows:DCP><ows:HTTP><ows:Get xlink:href=\"{}/wmts?\"><ows:Constraint "
      "name=\"GetEncoding\"><ows:AllowedValues><ows:Value>KVP</ows:Value></ows:AllowedValues></ows:Constraint>"
      "</ows:Get></ows:HTTP></ows:DCP></ows:Operation>\n",
      name, markup(base));
}

ordered_json addresses(const ServedSet& set, std::string_view base) {
  const std::string from = fmt::format("{}/{}", base, set.name);
  const char* ending = tile_ending(set.info());
  ordered_json all{{"xyz", tile_template(set, base)},
                   {"tms", fmt::format("{}/tms/{{z}}/{{x}}/{{y}}.{}", from, ending)}};
  if (system_of(set.info())) all["wmts"] = from + "/wmts/1.0.0/WMTSCapabilities.xml";
  if (tile_json(set, base)) all["tilejson"] = from + "/tilejson.json";
  if (set.archive) all["pmtiles"] = from + ".pmtiles";
  return all;
}

/// The first tiles of the coarsest level, as pictures in their rows and columns.
std::string pictures(const ServedSet& set, std::string_view base) {
  constexpr int kMost = 64;
  const TileSetInfo& info = set.info();
  if (info.numbers) return {};
  const int level = info.grid.min_level;
  const MatrixSize size = matrix_size(info, level);
  std::string html;
  std::int64_t row = 0;
  int count = 0;
  for_each_place(info.grid, level, [&](const TileId& id) {
    if (count > 0 && id.y != row) html += "<br>\n";
    row = id.y;
    if (id.x < size.columns && id.y < size.rows) {
      html += fmt::format("<img alt=\"\" loading=\"lazy\" src=\"{}/{}/{}/{}/{}.{}\">", markup(base), set.name,
                          level + first_zoom(info), id.x, id.y, tile_ending(info));
    }
    return ++count < kMost;
  });
  return "<p class=\"tiles\">" + html + "</p>\n";
}

std::string section(const ServedSet& set, std::string_view base) {
  const TileGrid& grid = set.info().grid;
  const int zoom = first_zoom(set.info());
  std::string html =
      fmt::format("<h2>{}</h2>\n<p>{}</p>\n<p>{}</p>\n<p>levels {} to {}, {} pixels a tile, {}</p>\n<dl>",
                  markup(title_of(set)), markup(set.info().attribution), markup(note_of(set.info())),
                  grid.min_level + zoom, grid.max_level + zoom, grid.tile_px, media_type(set.info()));
  const ordered_json listed = addresses(set, base);
  for (const auto& [kind, address] : listed.items()) {
    const std::string shown = markup(address.get<std::string>());
    html += shown.find('{') == shown.npos ? fmt::format("<dt>{}<dd><a href=\"{}\">{}</a>\n", kind, shown, shown)
                                          : fmt::format("<dt>{}<dd><code>{}</code>\n", kind, shown);
  }
  return html + "</dl>\n" + pictures(set, base);
}

}  // namespace

std::string tile_template(const ServedSet& set, std::string_view base) {
  return fmt::format("{}/{}/{{z}}/{{x}}/{{y}}.{}", base, set.name, tile_ending(set.info()));
}

Result<std::string> wmts_capabilities(std::span<const ServedSet> sets, std::string_view base) {
  std::string layers, matrices;
  Error last{"there are no sets"};
  for (const ServedSet& set : sets) {
    const auto system = system_of(set.info());
    if (!system) {
      last = Error{fmt::format("{} is not in the WMTS: {}; read it as XYZ", set.name, system.error().message)};
      continue;
    }
    layers += layer_xml(set, base);
    matrices += matrix_set_xml(set, *system);
  }
  if (layers.empty()) return last;
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Capabilities version=\"1.0.0\" "
      "xmlns=\"http://www.opengis.net/wmts/1.0\" xmlns:ows=\"http://www.opengis.net/ows/1.1\" "
      "xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n<ows:ServiceIdentification><ows:Title>Terrella</ows:Title>"
      "<ows:ServiceType>OGC WMTS</ows:ServiceType><ows:ServiceTypeVersion>1.0.0</ows:ServiceTypeVersion>"
      "</ows:ServiceIdentification>\n<ows:ServiceProvider><ows:ProviderName>{}</ows:ProviderName>"
      "</ows:ServiceProvider>\n<ows:OperationsMetadata>{}{}</ows:OperationsMetadata>\n"
      "<Contents>\n{}{}</Contents>\n</Capabilities>\n",
      markup(attributions(sets)), operation_xml("GetCapabilities", base), operation_xml("GetTile", base), layers,
      matrices);
}

Result<std::string> tile_json(const ServedSet& set, std::string_view base) {
  const TileGrid& grid = set.info().grid;
  if (grid.projection != Projection::web_mercator) {
    return Error{set.name + " has no TileJSON, which describes tiles in Web Mercator alone; read it as WMTS or XYZ"};
  }
  if (!is_of_earth(set.info())) {
    return Error{set.name + " has no TileJSON, which describes tiles of the Earth alone; read it as XYZ"};
  }
  const GeoRect bounds = web_bounds(grid);
  const int zoom = first_zoom(set.info());
  return dump({{"tilejson", "3.0.0"},
               {"name", title_of(set)},
               {"description", note_of(set.info())},
               {"attribution", set.info().attribution},
               {"scheme", "xyz"},
               {"tiles", {tile_template(set, base)}},
               {"tileSize", grid.tile_px},
               {"minzoom", grid.min_level + zoom},
               {"maxzoom", grid.max_level + zoom},
               {"bounds",
                {tidy_degrees(bounds.west), tidy_degrees(bounds.south), tidy_degrees(bounds.east),
                 tidy_degrees(bounds.north)}}});
}

std::string ogc_exception(std::string_view code, std::string_view text) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ExceptionReport xmlns=\"http://www.opengis.net/ows/1.1\" "
      "version=\"1.1.0\"><Exception exceptionCode=\"{}\"><ExceptionText>{}</ExceptionText></Exception>"
      "</ExceptionReport>\n",
      code, markup(text));
}

std::string overview_page(std::span<const ServedSet> sets, std::string_view base) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Terrella</title>\n"
      "<style>body{font-family:sans-serif;margin:2em}img{width:96px;height:96px;vertical-align:top;background:#ddd}"
      ".tiles{white-space:nowrap;overflow:auto;line-height:0}</style>\n<h1>Tile sets</h1>\n";
  for (const ServedSet& set : sets) html += section(set, base);
  return html + "</html>\n";
}

std::string addresses_json(std::span<const ServedSet> sets, std::string_view base, int port) {
  ordered_json json{{"address", fmt::format("{}/", base)}, {"port", port}, {"sets", ordered_json::array()}};
  for (const ServedSet& set : sets) {
    ordered_json one{{"name", set.name}};
    one.update(addresses(set, base));
    json["sets"].push_back(std::move(one));
  }
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

const char* media_type(const TileSetInfo& info) {
  return info.numbers && info.numbers->floats ? "image/tiff" : media_type(info.format);
}

const char* media_type(ImageFormat format) {
  switch (format) {
    case ImageFormat::jpeg:
      return "image/jpeg";
    case ImageFormat::webp:
      return "image/webp";
    case ImageFormat::png:
    case ImageFormat::unknown:
      break;
  }
  return "image/png";
}

}  // namespace terrella
