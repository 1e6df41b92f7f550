#include "apps/viewer/draw/drawing_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <span>
#include <sstream>
#include <utility>

#include "apps/process/write_file.h"
#include "apps/viewer/draw/drawing_scene.h"
#include "apps/viewer/draw/geojson_shape.h"
#include "streaming/file_bytes.h"
#include "streaming/objects/object_style.h"
#include "streaming/objects/vector_objects.h"

namespace terrella {
namespace {

using nlohmann::ordered_json;

// Three decimals tell all 256 steps.
double opacity_of(const ObjectColor& color) { return std::round(1000.0 / 255.0 * color.alpha) / 1000.0; }

ordered_json properties_of(const DrawnMark& mark) {
  ordered_json properties = ordered_json::object();
  if (!mark.name.empty()) properties["title"] = mark.name;
  const MarkLook& look = mark.look;
  if (mark.kind == MarkKind::place) {
    properties["marker-color"] = color_text(look.color);
    return properties;
  }
  properties["stroke"] = color_text(look.color);
  properties["stroke-opacity"] = opacity_of(look.color);
  properties["stroke-width"] = look.width_px;
  if (mark.kind == MarkKind::line) return properties;
  properties["fill"] = color_text(look.fill);
  properties["fill-opacity"] = opacity_of(look.fill);
  return properties;
}

ordered_json geometry_of(const DrawnMark& mark) {
  if (mark.kind == MarkKind::area) {
    return {{"type", "Polygon"}, {"coordinates", ordered_json::array({ring_positions(mark.places)})}};
  }
  const auto positions = line_positions(mark.places);
  if (mark.kind == MarkKind::line) return {{"type", "LineString"}, {"coordinates", positions}};
  return {{"type", "Point"}, {"coordinates", positions.front()}};
}

// XML has no control characters.
void add_text(pugi::xml_node parent, const char* name, std::string text) {
  std::erase_if(text, [](unsigned char c) { return c < ' ' && c != '\n' && c != '\t'; });
  parent.append_child(name).text().set(text.c_str());
}

void add_coordinates(pugi::xml_node parent, const std::vector<GeoJsonPosition>& positions) {
  std::string text;
  for (const auto& [lon_deg, lat_deg] : positions) {
    text += fmt::format("{}{},{}", text.empty() ? "" : " ", wrapped_lon_deg(lon_deg), lat_deg);
  }
  add_text(parent, "coordinates", text);
}

/// Adds a part of a KML style: its colour is alpha, blue, green, red.
pugi::xml_node add_style(pugi::xml_node style, const char* name, const ObjectColor& color) {
  pugi::xml_node part = style.append_child(name);
  add_text(part, "color", fmt::format("{:02x}{:02x}{:02x}{:02x}", color.alpha, color.blue, color.green, color.red));
  return part;
}

void add_look(const DrawnMark& mark, pugi::xml_node placemark) {
  pugi::xml_node style = placemark.append_child("Style");
  if (mark.kind == MarkKind::place) {
    add_style(style, "IconStyle", mark.look.color);
    return;
  }
  add_text(add_style(style, "LineStyle", mark.look.color), "width", fmt::format("{}", mark.look.width_px));
  if (mark.kind == MarkKind::area) add_style(style, "PolyStyle", mark.look.fill);
}

void add_placemark(const DrawnMark& mark, pugi::xml_node document) {
  pugi::xml_node placemark = document.append_child("Placemark");
  if (!mark.name.empty()) add_text(placemark, "name", mark.name);
  add_look(mark, placemark);
  if (mark.kind == MarkKind::place) {
    return add_coordinates(placemark.append_child("Point"), line_positions(mark.places));
  }
  const bool is_line = mark.kind == MarkKind::line;
  pugi::xml_node shape = placemark.append_child(is_line ? "LineString" : "Polygon");
  add_text(shape, "tessellate", "1");
  if (is_line) return add_coordinates(shape, line_positions(mark.places));
  add_coordinates(shape.append_child("outerBoundaryIs").append_child("LinearRing"), ring_positions(mark.places));
}

}  // namespace

std::string drawing_geojson(const Drawing& drawing) {
  ordered_json features = ordered_json::array();
  for (const DrawnMark& mark : drawing.marks) {
    features.push_back({{"type", "Feature"}, {"properties", properties_of(mark)}, {"geometry", geometry_of(mark)}});
  }
  const ordered_json whole{{"type", "FeatureCollection"}, {"features", std::move(features)}};
  return whole.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string drawing_kml(const Drawing& drawing) {
  pugi::xml_document xml;
  pugi::xml_node declaration = xml.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node kml = xml.append_child("kml");
  kml.append_attribute("xmlns") = "http://www.opengis.net/kml/2.2";
  pugi::xml_node document = kml.append_child("Document");
  for (const DrawnMark& mark : drawing.marks) add_placemark(mark, document);
  std::ostringstream text;
  xml.save(text, "  ", pugi::format_indent, pugi::encoding_utf8);
  return text.str();
}

Status save_drawing(const std::filesystem::path& file, const Drawing& drawing) {
  const std::string ending = lower_extension(file);
  if (ending != ".kml" && ending != ".geojson" && ending != ".json") {
    return Error{file.string() + ": end the name in .geojson, .json or .kml, which says the format"};
  }
  const std::string text = ending == ".kml" ? drawing_kml(drawing) : drawing_geojson(drawing);
  return write_file(file, std::as_bytes(std::span(text)));
}

namespace {

Result<OpenedDrawing> marks_of(Result<ObjectFile> read) {
  if (!read) return read.error();
  SceneDrawing taken = drawing_of(read->scene);
  return OpenedDrawing{
      .drawing = std::move(taken.drawing), .left_out = taken.left_out, .complaints = std::move(read->complaints)};
}

}  // namespace

Result<OpenedDrawing> open_drawing(const std::filesystem::path& file) { return marks_of(read_objects(file)); }

Result<OpenedDrawing> parse_drawing(const std::string& geojson, const std::string& where) {
  std::istringstream stream(geojson);
  return marks_of(parse_geojson_objects(stream, where));
}

}  // namespace terrella
