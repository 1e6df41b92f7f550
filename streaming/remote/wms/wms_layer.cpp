#include "streaming/remote/wms/wms_layer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number.h"
#include "streaming/remote/wmts/ogc_choices.h"
#include "streaming/remote/wmts/xml_names.h"

namespace terrella {
namespace {

/// Limits on a document from outside.
constexpr int kMaxDepth = 32;
constexpr std::size_t kMaxLayers = 20'000;
constexpr std::size_t kMaxWmsListed = 10'000;

template <class T>
void append(std::vector<T>& list, T value) {
  if (list.size() < kMaxWmsListed) list.push_back(std::move(value));
}

std::optional<double> number_at(const pugi::xml_node& node, std::string_view attribute) {
  return to_number(trimmed(attribute_of(node, attribute)));
}

/// Bounds of degrees that may run from 0 to 360.
std::optional<GeoRect> rect_of(double west, double south, double east, double north) {
  south = std::clamp(south, -90.0, 90.0);
  north = std::clamp(north, -90.0, 90.0);
  if (!(west < east) || !(south < north) || std::abs(west) > 720.0 || std::abs(east) > 720.0) return std::nullopt;
  GeoRect rect{.south = Angle::degrees(south), .north = Angle::degrees(north)};
  if (east - west >= 360.0) return rect;
  rect.west = Angle::degrees(std::remainder(west, 360.0) >= 180.0 ? -180.0 : std::remainder(west, 360.0));
  const double wrapped = std::remainder(east, 360.0);
  rect.east = Angle::degrees(wrapped <= -180.0 ? 180.0 : wrapped);
  return rect;
}

std::optional<GeoRect> read_wms_bounds(const pugi::xml_node& layer) {
  if (const pugi::xml_node box = child_of(layer, "EX_GeographicBoundingBox")) {
    const auto side = [&](std::string_view name) { return to_number(text_of(box, name)); };
    const auto west = side("westBoundLongitude");
    const auto south = side("southBoundLatitude");
    const auto east = side("eastBoundLongitude");
    const auto north = side("northBoundLatitude");
    // West over east is a box over 180°.
    if (west && south && east && north) return rect_of(*west, *south, *east < *west ? *east + 360.0 : *east, *north);
  }
  const pugi::xml_node box = child_of(layer, "LatLonBoundingBox");
  const auto west = number_at(box, "minx");
  const auto south = number_at(box, "miny");
  const auto east = number_at(box, "maxx");
  const auto north = number_at(box, "maxy");
  if (!west || !south || !east || !north) return std::nullopt;
  return rect_of(*west, *south, *east, *north);
}

std::vector<WmsBox> read_boxes(const pugi::xml_node& layer) {
  std::vector<WmsBox> boxes;
  for (const pugi::xml_node& node : children_of(layer, "BoundingBox")) {
    std::string crs(trimmed(attribute_of(node, "CRS")));
    if (crs.empty()) crs = trimmed(attribute_of(node, "SRS"));
    const auto x0 = number_at(node, "minx");
    const auto y0 = number_at(node, "miny");
    const auto x1 = number_at(node, "maxx");
    const auto y1 = number_at(node, "maxy");
    if (x0 && y0 && x1 && y1 && *x0 < *x1 && *y0 < *y1) append(boxes, WmsBox{std::move(crs), *x0, *y0, *x1, *y1});
  }
  return boxes;
}

void append_words(std::string_view text, std::string_view separators, std::vector<std::string>& words) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (const auto word = trimmed(text.substr(0, end)); !word.empty()) append(words, std::string(word));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// Version 1.1 lists several systems in one element, separated by spaces.
std::vector<std::string> read_systems(const pugi::xml_node& layer) {
  std::vector<std::string> systems;
  for (const char* element : {"CRS", "SRS"}) {
    for (const pugi::xml_node& node : children_of(layer, element)) append_words(node.child_value(), " \t\r\n", systems);
  }
  return systems;
}

/// Version 1.1 puts the values into <Extent>, version 1.3 into <Dimension> itself.
std::vector<WmtsDimension> read_dimensions(const pugi::xml_node& layer) {
  std::vector<WmtsDimension> dimensions;
  for (const char* element : {"Dimension", "Extent"}) {
    for (const pugi::xml_node& node : children_of(layer, element)) {
      WmtsDimension dimension{.name = std::string(trimmed(attribute_of(node, "name"))),
                              .otherwise = std::string(trimmed(attribute_of(node, "default"))),
                              .values = {}};
      append_words(node.child_value(), ",", dimension.values);
      const bool declares_only = dimension.values.empty() && dimension.otherwise.empty();
      if (!dimension.name.empty() && !declares_only) append(dimensions, std::move(dimension));
    }
  }
  return dimensions;
}

void read_scales(const pugi::xml_node& node, WmsLayer& layer) {
  const auto positive = [](std::optional<double> scale) { return scale && *scale > 0.0 ? scale : std::nullopt; };
  const auto least = positive(to_number(text_of(node, "MinScaleDenominator")));
  const auto most = positive(to_number(text_of(node, "MaxScaleDenominator")));
  if (least) layer.min_scale = least;
  if (most) layer.max_scale = most;
  const pugi::xml_node hint = child_of(node, "ScaleHint");
  if (!hint) return;
  // A hint is the diagonal of a pixel in metres.
  const auto scale = [&](const char* attribute) {
    const auto diagonal_m = positive(number_at(hint, attribute));
    return diagonal_m ? std::optional(*diagonal_m / std::sqrt(2.0) / kOgcPixel_m) : std::nullopt;
  };
  layer.min_scale = scale("min");
  layer.max_scale = scale("max");
}

template <class T>
void put_before(std::vector<T> own, std::vector<T>& inherited) {
  own.insert(own.end(), inherited.begin(), inherited.end());
  inherited = std::move(own);
}

/// Reads the layer of `node`; `layer` has the values that the layer around it hands on.
WmsLayer read_layer(const pugi::xml_node& node, WmsLayer layer) {
  layer.name = text_of(node, "Name");
  layer.title = text_of(node, "Title");
  const auto attribution = text_of(child_of(node, "Attribution"), "Title");
  if (!attribution.empty()) layer.attribution = attribution;
  put_before(read_systems(node), layer.crs);
  std::vector<std::string> styles;
  for (const pugi::xml_node& style : children_of(node, "Style")) append(styles, std::string(text_of(style, "Name")));
  put_before(std::move(styles), layer.styles);
  put_before(read_boxes(node), layer.boxes);
  if (auto bounds = read_wms_bounds(node)) layer.bounds = bounds;
  read_scales(node, layer);
  const std::string_view opaque = attribute_of(node, "opaque");
  if (!opaque.empty()) layer.opaque = opaque == "1" || opaque == "true";
  if (auto dimensions = read_dimensions(node); !dimensions.empty()) layer.dimensions = std::move(dimensions);
  return layer;
}

void read_below(const pugi::xml_node& node, const WmsLayer& around, int depth, std::vector<WmsLayer>& layers) {
  for (const pugi::xml_node& child : children_of(node, "Layer")) {
    if (layers.size() >= kMaxLayers) return;
    const WmsLayer layer = read_layer(child, around);
    if (!layer.name.empty()) layers.push_back(layer);
    if (depth < kMaxDepth) read_below(child, layer, depth + 1, layers);
  }
}

}  // namespace

std::vector<WmsLayer> read_wms_layers(const pugi::xml_node& capability) {
  std::vector<WmsLayer> layers;
  read_below(capability, {}, 1, layers);
  return layers;
}

}  // namespace terrella
