#include "streaming/remote/wmts/wmts_layer.h"

#include <algorithm>

#include "base/number.h"
#include "streaming/remote/wmts/xml_names.h"

namespace terrella {
namespace {

constexpr std::size_t kMaxListed = 100'000;

std::vector<std::string> read_styles(const pugi::xml_node& layer) {
  std::vector<std::string> styles;
  for (const pugi::xml_node& style : children_of(layer, "Style")) {
    const std::string_view marked = attribute_of(style, "isDefault");
    const bool first = marked == "true" || marked == "1";
    styles.emplace(first ? styles.begin() : styles.end(), text_of(style, "Identifier"));
  }
  return styles;
}

void append_values(std::string_view list, std::vector<std::string>& values) {
  while (!list.empty() && values.size() < kMaxListed) {
    const std::size_t comma = std::min(list.find(','), list.size());
    if (const auto value = trimmed(list.substr(0, comma)); !value.empty()) values.emplace_back(value);
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
}

WmtsDimension read_dimension(const pugi::xml_node& node) {
  WmtsDimension dimension{std::string(text_of(node, "Identifier")), std::string(text_of(node, "Default")), {}};
  for (const pugi::xml_node& value : children_of(node, "Value")) append_values(value.child_value(), dimension.values);
  return dimension;
}

/// Reads bounds with longitude first, whatever the reference systems of the matrices.
std::optional<GeoRect> read_bounds(const pugi::xml_node& layer) {
  const pugi::xml_node box = child_of(layer, "WGS84BoundingBox");
  const auto low = to_pair(text_of(box, "LowerCorner"));
  const auto high = to_pair(text_of(box, "UpperCorner"));
  if (!low || !high) return std::nullopt;
  const GeoRect bounds{.west = Angle::degrees(std::clamp(low->first, -180.0, 180.0)),
                       .south = Angle::degrees(std::clamp(low->second, -90.0, 90.0)),
                       .east = Angle::degrees(std::clamp(high->first, -180.0, 180.0)),
                       .north = Angle::degrees(std::clamp(high->second, -90.0, 90.0))};
  const bool area = bounds.south < bounds.north && bounds.west < bounds.east;
  return area ? std::optional(bounds) : std::nullopt;
}

bool speaks_kvp(const pugi::xml_node& get) {
  const auto constraints = children_of(get, "Constraint");
  if (constraints.empty()) return true;
  return std::ranges::any_of(constraints, [](const pugi::xml_node& constraint) {
    return std::ranges::any_of(children_of(child_of(constraint, "AllowedValues"), "Value"),
                               [](const pugi::xml_node& value) { return trimmed(value.child_value()) == "KVP"; });
  });
}

}  // namespace

WmtsLayer read_wmts_layer(const pugi::xml_node& node) {
  WmtsLayer layer{.name = std::string(text_of(node, "Identifier")), .title = std::string(text_of(node, "Title"))};
  layer.styles = read_styles(node);
  for (const pugi::xml_node& format : children_of(node, "Format")) {
    layer.formats.emplace_back(trimmed(format.child_value()));
  }
  for (const pugi::xml_node& link : children_of(node, "TileMatrixSetLink")) {
    layer.links.push_back({std::string(text_of(link, "TileMatrixSet")), read_limits(link)});
  }
  for (const pugi::xml_node& dimension : children_of(node, "Dimension")) {
    layer.dimensions.push_back(read_dimension(dimension));
  }
  for (const pugi::xml_node& resource : children_of(node, "ResourceURL")) {
    if (attribute_of(resource, "resourceType") != "tile") continue;
    layer.resources.push_back({std::string(trimmed(attribute_of(resource, "format"))),
                               std::string(trimmed(attribute_of(resource, "template")))});
  }
  layer.bounds = read_bounds(node);
  return layer;
}

std::string kvp_address(const pugi::xml_node& capabilities) {
  for (const pugi::xml_node& operation : children_of(child_of(capabilities, "OperationsMetadata"), "Operation")) {
    if (attribute_of(operation, "name") != "GetTile") continue;
    for (const pugi::xml_node& get : children_of(child_of(child_of(operation, "DCP"), "HTTP"), "Get")) {
      if (speaks_kvp(get)) return std::string(trimmed(attribute_of(get, "href")));
    }
  }
  return {};
}

}  // namespace terrella
