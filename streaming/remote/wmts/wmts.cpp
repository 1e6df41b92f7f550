#include "streaming/remote/wmts/wmts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "base/result.h"
#include "streaming/remote/tile_set_time.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/remote/wmts/wmts_grid.h"
#include "streaming/remote/wmts/wmts_layer.h"
#include "streaming/remote/wmts/xml_names.h"

namespace terrella {
namespace {

/// Parameters common to all tile requests of a layer.
struct WmtsRequest {
  std::string layer{};
  std::string style{};
  std::string matrix_set{};
  std::string media_type{};
  std::map<std::string, std::string> dimensions{};  ///< by the name in the document, encoded; the time is {time}
};

/// Replacement for a placeholder; nothing if unknown. Ignores case, because writers differ.
std::optional<std::string> value_of(std::string_view name, const WmtsRequest& request) {
  if (same_letters(name, "TileMatrix")) return "{z}";
  if (same_letters(name, "TileRow")) return "{row}";
  if (same_letters(name, "TileCol")) return "{col}";
  if (same_letters(name, "TileMatrixSet")) return percent_encode(request.matrix_set);
  if (same_letters(name, "Style")) return percent_encode(request.style);
  if (same_letters(name, "Layer")) return percent_encode(request.layer);
  for (const auto& [dimension, value] : request.dimensions) {
    if (same_letters(name, dimension)) return value;
  }
  return std::nullopt;
}

/// Converts a <ResourceURL>'s template to a RemoteTileSet's URL template. The error is the reason alone.
Result<std::string> rest_template(const std::string& wmts_template, const WmtsRequest& request) {
  std::string url;
  std::string_view rest = wmts_template;
  for (std::size_t at = rest.find('{'); at != std::string_view::npos; at = rest.find('{')) {
    const std::size_t end = rest.find('}', at);
    if (end == std::string_view::npos) return Error{"its ResourceURL has a brace without its other half"};
    const std::string_view name = rest.substr(at + 1, end - at - 1);
    const auto value = value_of(name, request);
    if (!value) return Error{fmt::format("its ResourceURL has the unknown placeholder {{{}}}", name.substr(0, 64))};
    url += rest.substr(0, at);
    url += *value;
    rest.remove_prefix(end + 1);
  }
  return url.append(rest);
}

/// Makes a URL template for GetTile with key-value pairs.
std::string kvp_template(const std::string& address, const WmtsRequest& request) {
  std::string url = encode_braces(address);
  if (url.find('?') == std::string::npos) url += '?';
  if (!url.ends_with('?') && !url.ends_with('&')) url += '&';
  url += fmt::format("SERVICE=WMTS&REQUEST=GetTile&VERSION=1.0.0&LAYER={}&STYLE={}&TILEMATRIXSET={}&FORMAT={}",
                     percent_encode(request.layer), percent_encode(request.style), percent_encode(request.matrix_set),
                     percent_encode(request.media_type));
  url += "&TILEMATRIX={z}&TILEROW={row}&TILECOL={col}";
  for (const auto& [dimension, value] : request.dimensions) {
    url += fmt::format("&{}={}", percent_encode(dimension), value);
  }
  return url;
}

/// Media types of each ImageFormat.
const std::array<std::vector<std::string_view>, 3> kTypes = {{
    {"image/jpeg", "image/jpg", "image/vnd.jpg-png", "image/jpgpng"},
    {"image/png", "image/png8", "image/png; mode=8bit"},
    {"image/webp"},
}};

Result<WmtsLayer> find_layer(const pugi::xml_node& contents, const std::string& wanted) {
  std::vector<std::string> names;
  const std::vector<pugi::xml_node> layers = children_of(contents, "Layer");
  for (const pugi::xml_node& node : layers) {
    names.emplace_back(text_of(node, "Identifier"));
    if (!wanted.empty() && names.back() == wanted) return read_wmts_layer(node);
  }
  if (wanted.empty() && layers.size() == 1) return read_wmts_layer(layers.front());
  if (wanted.empty()) return Error{fmt::format("say which of its layers with ‹layer›: {}", list_of(names))};
  const auto near = std::ranges::find_if(names, [&](const std::string& name) { return same_letters(name, wanted); });
  if (near != names.end()) return Error{fmt::format("it has no layer \"{}\", but \"{}\"", wanted, *near)};
  return Error{fmt::format("it has no layer \"{}\"; its layers: {}", wanted, list_of(names))};
}

Result<WmtsGrid> read_grid(const pugi::xml_node& contents, const WmtsLink& link, const std::optional<GeoRect>& bounds,
                           const RemoteOptions& options) {
  for (const pugi::xml_node& node : children_of(contents, "TileMatrixSet")) {
    if (text_of(node, "Identifier") != link.matrix_set) continue;
    const Result<WmtsMatrixSet> set = read_matrix_set(node);
    if (!set) return set.error();
    return grid_of(*set, link.limits, options.body, bounds);
  }
  return Error{"the document does not describe it"};
}

/// Rank of a kind of matrix set: 0 for the requested projection, else for longitude and latitude. Then comes Web
/// Mercator, then other systems.
int rank_of(const TileGrid& grid, const RemoteOptions& options) {
  if (grid.projection == Projection::projected) return 2;
  const bool mercator = grid.projection == Projection::web_mercator;
  return mercator == (options.projection == Projection::web_mercator) ? 0 : 1;
}

struct ChosenGrid {
  WmtsGrid placed;
  std::string matrix_set;
};

Result<ChosenGrid> choose_grid(const pugi::xml_node& contents, const WmtsLayer& layer, const RemoteOptions& options) {
  std::vector<std::string> names;
  std::string reasons;
  std::optional<ChosenGrid> best;
  const auto rank = [&](const WmtsGrid& placed) { return rank_of(placed.grid, options); };
  for (const WmtsLink& link : layer.links) {
    names.push_back(link.matrix_set);
    if (!options.matrix_set.empty() && link.matrix_set != options.matrix_set) continue;
    Result<WmtsGrid> placed = read_grid(contents, link, layer.bounds, options);
    if (placed) {
      if (!best || rank(*placed) < rank(best->placed)) best = ChosenGrid{*std::move(placed), link.matrix_set};
      if (rank(best->placed) == 0) break;
      continue;
    }
    if (names.size() <= 20) {
      reasons += fmt::format("; matrix set \"{}\": {}", link.matrix_set.substr(0, 100), placed.error().message);
    }
  }
  if (best) return *std::move(best);
  if (!reasons.empty()) return Error{fmt::format("layer \"{}\" cannot be shown{}", layer.name, reasons)};
  return Error{
      fmt::format("layer \"{}\" has no matrix set \"{}\"; it has: {}", layer.name, options.matrix_set, list_of(names))};
}

struct ChosenFormat {
  ImageFormat format;
  std::string media_type;
};

Result<ChosenFormat> choose_format(const WmtsLayer& layer, const RemoteOptions& options) {
  std::vector<std::string> types;
  for (const WmtsResource& resource : layer.resources) types.push_back(resource.format);
  if (layer.resources.empty()) types = layer.formats;
  const auto among = [&](std::span<const std::string_view> known) {
    return std::ranges::find_if(types, [&](const std::string& type) {
      return std::ranges::any_of(known, [&](std::string_view one) { return same_letters(one, type); });
    });
  };
  for (const ImageFormat format : {ImageFormat::jpeg, ImageFormat::png, ImageFormat::webp}) {
    if (options.format && options.format != format) continue;
    const auto type = among(kTypes.at(static_cast<std::size_t>(format)));
    if (type != types.end()) return ChosenFormat{format, *type};
  }
  return Error{fmt::format("layer \"{}\" has tiles as {}; {}image/jpeg, image/png and image/webp can be read",
                           layer.name, list_of(types),
                           options.format ? "the requested format is not among them; " : "")};
}

Result<std::string> choose_style(const WmtsLayer& layer, const std::string& wanted) {
  if (wanted.empty()) return layer.styles.empty() ? std::string("default") : layer.styles.front();
  if (std::ranges::find(layer.styles, wanted) != layer.styles.end()) return wanted;
  return Error{fmt::format("layer \"{}\" has no style \"{}\"; it has: {}", layer.name, wanted, list_of(layer.styles))};
}

/// Chooses a value for every dimension. Returns that of the time, which is empty for a layer without one.
Result<ChosenTime> choose_dimensions(const WmtsLayer& layer, const std::string& time, WmtsRequest& request) {
  ChosenTime chosen_time;
  bool has_time = false;
  for (const WmtsDimension& dimension : layer.dimensions) {
    const bool is_time = same_letters(dimension.name, "time");
    Result<ChosenTime> chosen = choose_time(dimension, is_time ? time : std::string());
    if (!chosen) return Error{fmt::format("layer \"{}\": {}", layer.name, chosen.error().message)};
    request.dimensions[dimension.name] = is_time ? "{time}" : percent_encode(chosen->value);
    if (is_time) chosen_time = *std::move(chosen);
    has_time = has_time || is_time;
  }
  if (!time.empty() && !has_time) return Error{fmt::format("layer \"{}\" has no time dimension", layer.name)};
  return chosen_time;
}

Result<std::string> make_url(const WmtsLayer& layer, const WmtsRequest& request, const pugi::xml_node& capabilities) {
  for (const WmtsResource& resource : layer.resources) {
    if (resource.format == request.media_type) return rest_template(resource.url_template, request);
  }
  const std::string address = kvp_address(capabilities);
  if (address.empty()) return Error{"it has neither a ResourceURL nor a GetTile with key-value pairs"};
  return kvp_template(address, request);
}

double clamped(Angle angle, Angle low, Angle high) { return std::clamp(angle.deg(), low.deg(), high.deg()); }

/// Intersection of both rectangles. Ignores a box that would leave nothing, or that needs more than one rectangle.
GeoRect narrowed(const GeoRect& tiles, const std::optional<GeoRect>& box) {
  if (!box || tiles.east < tiles.west) return tiles;
  const GeoRect both{.west = Angle::degrees(clamped(box->west, tiles.west, tiles.east)),
                     .south = Angle::degrees(clamped(box->south, tiles.south, tiles.north)),
                     .east = Angle::degrees(clamped(box->east, tiles.west, tiles.east)),
                     .north = Angle::degrees(clamped(box->north, tiles.south, tiles.north))};
  return both.west < both.east && both.south < both.north ? both : tiles;
}

/// Checks the user's options against the document's grid. Options may narrow the levels, but not change the grid.
Status check_against(const RemoteOptions& options, TileGrid& grid) {
  if (options.root_span_deg && grid.projection == Projection::projected) {
    return Error{"its tiles are in a coordinate system of their own, where ‹root_span_deg› has no meaning"};
  }
  if (options.root_span_deg && std::abs(*options.root_span_deg / grid.root_span_deg - 1.0) > 1e-9) {
    return Error{fmt::format("its root tile spans {}°, not the {}° that were given", grid.root_span_deg,
                             *options.root_span_deg)};
  }
  if (Status same = check_projection(grid, options); !same) return same;
  if (Status same = check_tile_px(grid, options); !same) return same;
  return narrow_levels(grid, options);
}

Result<RemoteTileSet> describe_layer(const pugi::xml_node& capabilities, const RemoteOptions& options) {
  const pugi::xml_node contents = child_of(capabilities, "Contents");
  const Result<WmtsLayer> layer = find_layer(contents, options.layer);
  if (!layer) return layer.error();
  const Result<ChosenFormat> format = choose_format(*layer, options);
  if (!format) return format.error();
  const Result<std::string> style = choose_style(*layer, options.style);
  if (!style) return style.error();
  Result<ChosenGrid> chosen = choose_grid(contents, *layer, options);
  if (!chosen) return chosen.error();
  if (Status checked = check_against(options, chosen->placed.grid); !checked) return checked.error();
  WmtsRequest request{.layer = layer->name,
                      .style = *style,
                      .matrix_set = chosen->matrix_set,
                      .media_type = format->media_type,
                      .dimensions = {}};
  Result<ChosenTime> time = choose_dimensions(*layer, options.time, request);
  if (!time) return time.error();
  const Result<std::string> url = make_url(*layer, request, capabilities);
  if (!url) return Error{fmt::format("layer \"{}\": {}", layer->name, url.error().message)};

  RemoteTileSet set;
  set.url = *url;
  set.info.grid = chosen->placed.grid;
  set.info.square = chosen->placed.square;
  if (!set.info.square) set.info.grid.bounds = narrowed(set.info.grid.bounds, layer->bounds);
  set.info.format = format->format;
  set.info.name = (layer->title.empty() ? layer->name : layer->title).substr(0, kMaxOgcTextBytes);
  set.info.attribution = text_of(child_of(capabilities, "ServiceProvider"), "ProviderName").substr(0, kMaxOgcTextBytes);
  set.info.body = chosen->placed.body;
  set.level_names = std::move(chosen->placed.level_names);
  set.shifts = std::move(chosen->placed.shifts);
  if (time->newest) set.missing_life = kNewestMissingLife;
  set_times(*std::move(time), set);
  return set;
}

/// Reason why a document is no WMTS capabilities; empty if it is.
std::string fault_of_root(const pugi::xml_node& root) {
  const std::string_view name = local_name(root.name());
  if (name == "ExceptionReport") {
    const auto text = text_of(child_of(root, "Exception"), "ExceptionText");
    return fmt::format("the server answers with an exception: {}", text.substr(0, 300));
  }
  if (name == "Capabilities" && child_of(root, "Contents")) return {};
  if (name.starts_with("WMS") || name.starts_with("WMT_MS")) {
    return "the capabilities of a WMS; give their address as \"wms\", or by itself";
  }
  return fmt::format("not the capabilities of a WMTS: its root is <{}>, or it has no <Contents>", name.substr(0, 64));
}

}  // namespace

Result<RemoteTileSet> parse_wmts_capabilities(std::string_view xml, const RemoteOptions& options,
                                              const std::string& where) {
  return read_capabilities(xml, options, where, fault_of_root,
                           [&](const pugi::xml_node& root) { return describe_layer(root, options); });
}

}  // namespace terrella
