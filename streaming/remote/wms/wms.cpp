#include "streaming/remote/wms/wms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <pugixml.hpp>
#include <span>

#include "base/number.h"
#include "streaming/remote/tile_set_time.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote/wms/wms_grid.h"
#include "streaming/remote/wms/wms_layer.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/remote/wmts/xml_names.h"
#include "streaming/sets/tile_check.h"

namespace terrella {
namespace {

/// Media types of each ImageFormat.
const std::array<std::vector<std::string_view>, 3> kMapTypes = {{
    {"image/jpeg", "image/jpg"},
    {"image/png", "image/png; mode=24bit", "image/png24", "image/png8"},
    {"image/webp"},
}};

std::string names_of(const std::vector<WmsLayer>& layers) {
  std::vector<std::string> names;
  for (const WmsLayer& layer : layers) names.push_back(layer.name);
  return list_of(names);
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    parts.push_back(list.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

/// Joins layers that are drawn over each other: choices must be offered by all of them. The first gives the rest.
void join(WmsLayer& all, const WmsLayer& next) {
  all.name += "," + next.name;
  all.title += ", " + next.title;
  std::erase_if(all.crs, [&](const std::string& crs) {
    return std::ranges::none_of(next.crs, [&](const std::string& one) { return same_letters(one, crs); });
  });
  all.opaque = all.opaque || next.opaque;
  all.bounds.reset();
}

Result<WmsLayer> find_layer(const std::vector<WmsLayer>& layers, const std::string& wanted) {
  if (wanted.empty() && layers.size() == 1) return layers.front();
  if (wanted.empty()) {
    return Error{fmt::format("say which of its layers with ‹layer›: {}", names_of(layers))};
  }
  std::optional<WmsLayer> found;
  for (const std::string& name : split(wanted)) {
    const auto layer = std::ranges::find(layers, name, &WmsLayer::name);
    if (layer == layers.end()) {
      return Error{fmt::format("it has no layer \"{}\"; its layers: {}", name.substr(0, 100), names_of(layers))};
    }
    if (found) {
      join(*found, *layer);
    } else {
      found = *layer;
    }
  }
  return *found;
}

struct MapFormat {
  ImageFormat format;
  std::string media_type;
};

/// Chooses a format: JPEG first for an opaque layer, because JPEG is smaller; else PNG or WebP, which keep
/// transparency.
Result<MapFormat> choose_format(const std::vector<std::string>& offered, const WmsLayer& layer,
                                const std::string& wanted, const RemoteOptions& options) {
  std::vector<ImageFormat> order = {ImageFormat::png, ImageFormat::webp};
  order.insert(layer.opaque ? order.begin() : order.end(), ImageFormat::jpeg);
  for (const ImageFormat format : order) {
    if (options.format && *options.format != format) continue;
    for (const std::string_view type : kMapTypes.at(static_cast<std::size_t>(format))) {
      const auto found = std::ranges::find_if(offered, [&](const std::string& one) {
        const bool fits = wanted.empty() || options.format || same_letters(one, wanted);
        return fits && same_letters(one, type);
      });
      if (found != offered.end()) return MapFormat{format, *found};
    }
  }
  return Error{fmt::format("it offers pictures as {}; {}image/png, image/jpeg and image/webp can be read",
                           list_of(offered), wanted.empty() ? "" : "the requested format is not among them; ")};
}

Result<std::string> choose_style(const WmsLayer& layer, const std::string& wanted) {
  if (wanted.empty()) return std::string(static_cast<std::size_t>(std::ranges::count(layer.name, ',')), ',');
  for (const std::string& style : split(wanted)) {
    if (style.empty() || style == "default" || std::ranges::find(layer.styles, style) != layer.styles.end()) continue;
    return Error{fmt::format("layer \"{}\" has no style \"{}\"; it has: {}", layer.name, style.substr(0, 100),
                             list_of(layer.styles))};
  }
  return wanted;
}

struct Times {
  std::string parameters;  ///< "&TIME={time}"
  ChosenTime time;         ///< empty for a layer without one
};

Result<Times> choose_times(const WmsLayer& layer, const std::string& wanted) {
  Times times;
  bool has_time = false;
  for (const WmtsDimension& dimension : layer.dimensions) {
    const bool is_time = same_letters(dimension.name, "time");
    // The server's default of another dimension needs no parameter.
    if (!is_time && !dimension.otherwise.empty()) continue;
    Result<ChosenTime> chosen = choose_time(dimension, is_time ? wanted : std::string());
    if (!chosen) return Error{fmt::format("layer \"{}\": {}", layer.name, chosen.error().message)};
    const bool is_height = same_letters(dimension.name, "elevation");
    const std::string name = is_time ? "TIME" : is_height ? "ELEVATION" : "DIM_" + percent_encode(dimension.name);
    times.parameters += fmt::format("&{}={}", name, is_time ? "{time}" : percent_encode(chosen->value));
    if (is_time) times.time = *std::move(chosen);
    has_time = has_time || is_time;
  }
  if (!wanted.empty() && !has_time) return Error{fmt::format("layer \"{}\" has no time dimension", layer.name)};
  return times;
}

/// Parts of the document apart from its layers.
struct Service {
  bool version_1_3 = true;
  std::string version;
  std::string provider;
  std::string get_map;  ///< address for GetMap
  std::vector<std::string> formats;
  WmsLimits limits;
};

int limit_of(const pugi::xml_node& service) {
  int most = 0;
  for (const char* element : {"MaxWidth", "MaxHeight"}) {
    const auto said = to_integer(text_of(service, element));
    if (said && *said > 0 && *said < 1'000'000)
      most = most == 0 ? static_cast<int>(*said) : std::min(most, static_cast<int>(*said));
  }
  return most;
}

Result<Service> read_service(const pugi::xml_node& root) {
  Service all;
  all.version = attribute_of(root, "version");
  all.version_1_3 = all.version.starts_with("1.3");
  if (!all.version_1_3 && !all.version.starts_with("1.1")) {
    return Error{fmt::format("version {} of WMS, and 1.1.1 and 1.3.0 are read", all.version.substr(0, 20))};
  }
  const pugi::xml_node service = child_of(root, "Service");
  const pugi::xml_node person = child_of(child_of(service, "ContactInformation"), "ContactPersonPrimary");
  all.provider = text_of(person, "ContactOrganization");
  all.limits = {.version_1_3 = all.version_1_3, .max_side_px = limit_of(service)};
  const pugi::xml_node map = child_of(child_of(child_of(root, "Capability"), "Request"), "GetMap");
  for (const pugi::xml_node& format : children_of(map, "Format")) {
    if (all.formats.size() < 1000) all.formats.emplace_back(trimmed(format.child_value()));
  }
  for (const pugi::xml_node& way : children_of(map, "DCPType")) {
    const pugi::xml_node get = child_of(child_of(way, "HTTP"), "Get");
    if (all.get_map.empty()) all.get_map = trimmed(attribute_of(child_of(get, "OnlineResource"), "href"));
  }
  if (all.get_map.empty()) return Error{"it gives no address for GetMap"};
  return all;
}

std::string request_for(const Service& service, const WmsLayer& layer, const WmsGrid& placed, const std::string& style,
                        const MapFormat& format, const WmsAddress& said) {
  std::string url = wms_base(service.get_map, said.extra);
  url +=
      fmt::format("SERVICE=WMS&VERSION={}&REQUEST=GetMap&LAYERS={}&STYLES={}&{}={}&FORMAT={}",
                  service.version_1_3 ? "1.3.0" : service.version, percent_encode(layer.name), percent_encode(style),
                  service.version_1_3 ? "CRS" : "SRS", percent_encode(placed.crs), percent_encode(format.media_type));
  if (format.format != ImageFormat::jpeg && !layer.opaque) url += "&TRANSPARENT=TRUE";
  url += fmt::format("&WIDTH={0}&HEIGHT={0}&BBOX={{bbox}}", placed.grid.tile_px);
  return url;
}

Result<RemoteTileSet> describe(const pugi::xml_node& root, const WmsAddress& said, const RemoteOptions& options) {
  const Result<Service> service = read_service(root);
  if (!service) return service.error();
  const auto prefer = [](const std::string& one, const std::string& other) { return one.empty() ? other : one; };
  const Result<WmsLayer> layer =
      find_layer(read_wms_layers(child_of(root, "Capability")), prefer(options.layer, said.layers));
  if (!layer) return layer.error();
  const Result<MapFormat> format = choose_format(service->formats, *layer, said.format, options);
  if (!format) return format.error();
  const Result<std::string> style = choose_style(*layer, prefer(options.style, said.styles));
  if (!style) return style.error();
  Result<Times> times = choose_times(*layer, prefer(options.time, said.time));
  if (!times) return times.error();
  Result<WmsGrid> placed = choose_wms_grid(*layer, service->limits, said.crs, options);
  if (!placed) return Error{fmt::format("layer \"{}\": {}", layer->name.substr(0, 100), placed.error().message)};
  if (placed->square && (options.projection || options.bounds)) {
    return Error{fmt::format("layer \"{}\" is in {}; leave projection and bounds out", layer->name, placed->crs)};
  }
  if (Status same = check_projection(placed->grid, options); !same) return same.error();
  if (Status limited = narrow_levels(placed->grid, options); !limited) return limited.error();
  RemoteTileSet set;
  set.url = request_for(*service, *layer, *placed, *style, *format, said) + times->parameters;
  set.northing_first = placed->northing_first;
  set.info.grid = placed->grid;
  set.info.square = placed->square;
  set.info.body = placed->body;
  set.info.format = format->format;
  set.info.name = (layer->title.empty() ? layer->name : layer->title).substr(0, kMaxOgcTextBytes);
  set.info.attribution = prefer(layer->attribution, service->provider).substr(0, kMaxOgcTextBytes);
  if (times->time.newest) set.missing_life = kNewestMissingLife;
  set_times(std::move(times->time), set);
  return set;
}

/// Reason why a document is no WMS capabilities; empty if it is.
std::string fault_of_wms_root(const pugi::xml_node& root) {
  const std::string_view name = local_name(root.name());
  if ((name == "WMS_Capabilities" || name == "WMT_MS_Capabilities") && child_of(root, "Capability")) return {};
  return fmt::format("not the capabilities of a WMS: its root is <{}>, or it has no <Capability>", name.substr(0, 64));
}

}  // namespace

Result<RemoteTileSet> parse_wms_capabilities(std::string_view xml, const WmsAddress& said, const RemoteOptions& options,
                                             const std::string& where) {
  if (const std::string told = server_exception(xml.substr(0, kMaxCapabilitiesBytes)); !told.empty()) {
    return Error{fmt::format("{}: the server answers with an exception: {}", where, told)};
  }
  return read_capabilities(xml, options, where, fault_of_wms_root,
                           [&](const pugi::xml_node& root) { return describe(root, said, options); });
}

}  // namespace terrella
