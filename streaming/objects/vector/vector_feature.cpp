#include "streaming/objects/vector/vector_feature.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "base/number.h"
#include "streaming/objects/geojson_objects.h"

namespace terrella {
namespace {

using nlohmann::json;

json position_of(OGRGeometryH line, int index) {
  json position{gdal().OGR_G_GetX(line, index), gdal().OGR_G_GetY(line, index)};
  if (gdal().OGR_G_Is3D(line) != 0) position.push_back(gdal().OGR_G_GetZ(line, index));
  return position;
}

json positions_of(OGRGeometryH line) {
  json positions = json::array();
  for (int i = 0; i < gdal().OGR_G_GetPointCount(line); ++i) positions.push_back(position_of(line, i));
  return positions;
}

template <class Read>
json parts_of(OGRGeometryH geometry, const Read& read) {
  json parts = json::array();
  for (int i = 0; i < gdal().OGR_G_GetGeometryCount(geometry); ++i) {
    OGRGeometryH part = gdal().OGR_G_GetGeometryRef(geometry, i);
    if (gdal().OGR_G_IsEmpty(part) == 0) parts.push_back(read(part));
  }
  return parts;
}

json rings_of_polygon(OGRGeometryH polygon) { return parts_of(polygon, positions_of); }

json with_coordinates(const char* type, json coordinates) {
  return {{"type", type}, {"coordinates", std::move(coordinates)}};
}

/// Null for a kind that GeoJSON does not have.
json read_flat(OGRGeometryH geometry) {
  switch (gdal().OGR_GT_Flatten(gdal().OGR_G_GetGeometryType(geometry))) {
    case wkbPoint:
      return with_coordinates("Point", position_of(geometry, 0));
    case wkbLineString:
      return with_coordinates("LineString", positions_of(geometry));
    case wkbPolygon:
      return with_coordinates("Polygon", rings_of_polygon(geometry));
    case wkbMultiPoint:
      return with_coordinates("MultiPoint", parts_of(geometry, [](OGRGeometryH one) { return position_of(one, 0); }));
    case wkbMultiLineString:
      return with_coordinates("MultiLineString", parts_of(geometry, positions_of));
    case wkbMultiPolygon:
      return with_coordinates("MultiPolygon", parts_of(geometry, rings_of_polygon));
    case wkbGeometryCollection:
      return {{"type", "GeometryCollection"}, {"geometries", parts_of(geometry, read_flat)}};
    default:
      return {{"type", gdal().OGR_G_GetGeometryName(geometry)}};  // GeoJSON's reader refuses it by name
  }
}

/// Text in UTF-8: other bytes become question marks.
std::string utf8_of(const char* text) {
  if (text == nullptr) return {};
  if (gdal().CPLIsUTF8(text, -1) != 0) return text;
  char* const plain = gdal().CPLForceToASCII(text, -1, '?');
  std::string copy = plain == nullptr ? "" : plain;
  gdal().VSIFree(plain);
  return copy;
}

json value_of(OGRFeatureH feature, OGRFieldDefnH field, int index) {
  const OGRFieldType type = gdal().OGR_Fld_GetType(field);
  if (type == OFTInteger && gdal().OGR_Fld_GetSubType(field) == OFSTBoolean) {
    return gdal().OGR_F_GetFieldAsInteger64(feature, index) != 0;
  }
  if (type == OFTInteger || type == OFTInteger64) {
    return static_cast<std::int64_t>(gdal().OGR_F_GetFieldAsInteger64(feature, index));
  }
  if (type == OFTReal) {
    const double number = gdal().OGR_F_GetFieldAsDouble(feature, index);
    return std::isfinite(number) ? json(number) : json();
  }
  return utf8_of(gdal().OGR_F_GetFieldAsString(feature, index));
}

/// The scale of a KML icon. GDAL would convert it, as sizes that have a unit; these are of other formats.
std::optional<double> icon_scale(std::string_view style) {
  constexpr std::string_view kSize = ",s:";
  const std::size_t at = style.find(kSize);
  if (at == std::string_view::npos) return {};
  const std::string_view said = style.substr(at + kSize.size());
  double scale = 0.0;
  const auto [end, fault] = std::from_chars(said.data(), said.data() + said.size(), scale);
  if (fault != std::errc() || end == said.data() + said.size() || (*end != ',' && *end != ')')) return {};
  return scale;
}

/// A part of a style: a pen, a brush or a symbol.
class StyleTool {
 public:
  StyleTool(OGRStyleMgrH styles, int part, const char* style) : tool_(gdal().OGR_SM_GetPart(styles, part, style)) {
    if (tool_ != nullptr) gdal().OGR_ST_SetUnit(tool_, OGRSTUPixel, 1.0);
  }
  ~StyleTool() {
    if (tool_ != nullptr) gdal().OGR_ST_Destroy(tool_);
  }
  StyleTool(const StyleTool&) = delete;
  StyleTool& operator=(const StyleTool&) = delete;

  [[nodiscard]] OGRSTClassId kind() const { return tool_ == nullptr ? OGRSTCNone : gdal().OGR_ST_GetType(tool_); }

  /// Adds a colour "#rrggbb" or "#rrggbbaa" of the style, with its opacity if `opacity` is named.
  void add_colour(int parameter, const char* name, const char* opacity, json& properties) const {
    int is_absent = 1;
    const char* text = gdal().OGR_ST_GetParamStr(tool_, parameter, &is_absent);
    const std::string_view colour = text == nullptr || is_absent != 0 ? "" : text;
    if (!colour.starts_with('#') || (colour.size() != 7 && colour.size() != 9) || properties.contains(name)) return;
    properties[name] = colour.substr(0, 7);
    if (opacity == nullptr || colour.size() == 7 || properties.contains(opacity)) return;
    unsigned alpha = 255;
    std::from_chars(colour.data() + 7, colour.data() + 9, alpha, 16);
    properties[opacity] = static_cast<double>(alpha) / 255.0;
  }

  /// Adds the picture of a KML icon that is no address, its colour, its size and its direction.
  void add_icon(double scale, json& properties) const {
    constexpr double kIcon_px = 32.0;  // longer side at scale 1, as in Google Earth
    int is_absent = 1;
    const char* picture = gdal().OGR_ST_GetParamStr(tool_, OGRSTSymbolId, &is_absent);
    const std::string name = picture == nullptr || is_absent != 0 ? "" : picture;
    if (name.empty() || name.find("://") != std::string::npos || properties.contains("icon")) return;
    properties["icon"] = name;
    add_colour(OGRSTSymbolColor, "icon-color", nullptr, properties);
    const double angle = gdal().OGR_ST_GetParamDbl(tool_, OGRSTSymbolAngle, &is_absent);
    if (is_absent == 0) properties["heading_deg"] = angle;
    properties["icon-size"] = kIcon_px * scale;
  }

  void add_width(json& properties) const {
    int is_absent = 1;
    const double width_px = gdal().OGR_ST_GetParamDbl(tool_, OGRSTPenWidth, &is_absent);
    if (is_absent == 0 && width_px >= 0.0 && !properties.contains("stroke-width"))
      properties["stroke-width"] = width_px;
  }

 private:
  OGRStyleToolH tool_;
};

/// Adds the scale of a KML icon as one of the three sizes of simplestyle.
void add_marker_size(double scale, json& properties) {
  constexpr double kSmall = 0.75, kLarge = 1.25;
  if (properties.contains("marker-size")) return;
  properties["marker-size"] = scale < kSmall ? "small" : scale > kLarge ? "large" : "medium";
}

/// Returns a field as milliseconds since 1970; none if it has no time. A time without a zone is in UTC.
std::optional<std::int64_t> milliseconds_of(OGRFeatureH feature, int field) {
  constexpr int kUtc = 100, kQuarter_min = 15;  // GDAL's flags of zones are quarters of an hour from kUtc
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, zone = 0;
  float second = 0.0F;
  if (gdal().OGR_F_IsFieldSetAndNotNull(feature, field) == 0 ||
      gdal().OGR_F_GetFieldAsDateTimeEx(feature, field, &year, &month, &day, &hour, &minute, &second, &zone) == 0)
    return {};
  using namespace std::chrono;
  const year_month_day date = std::chrono::year(year) / month / day;
  if (!date.ok()) return {};
  const int ahead_min = zone > 1 ? kQuarter_min * (zone - kUtc) : 0;
  const auto time =
      sys_days(date) + hours(hour) + minutes(minute - ahead_min) + milliseconds(std::lround(1e3F * second));
  return milliseconds(time.time_since_epoch()).count();
}

}  // namespace

Result<json> geojson_of(OGRGeometryH geometry) {
  if (geometry == nullptr || gdal().OGR_G_IsEmpty(geometry) != 0) return json();
  const std::unique_ptr<void, decltype(gdal().OGR_G_DestroyGeometry)> flat(
      gdal().OGR_G_GetLinearGeometry(geometry, 0.0, nullptr), gdal().OGR_G_DestroyGeometry);
  if (!flat) return Error{"its curves cannot be read"};
  if (gdal().OGR_G_WkbSize(flat.get()) / static_cast<int>(sizeof(double)) > static_cast<int>(kMaxFeatureValues)) {
    return Error{fmt::format("it has more than {} numbers; divide it", kMaxFeatureValues)};
  }
  return read_flat(flat.get());
}

json properties_of(OGRFeatureH feature, OGRFeatureDefnH definition) {
  json properties = json::object();
  for (int i = 0; i < gdal().OGR_FD_GetFieldCount(definition); ++i) {
    if (gdal().OGR_F_IsFieldSetAndNotNull(feature, i) == 0) continue;
    OGRFieldDefnH field = gdal().OGR_FD_GetFieldDefn(definition, i);
    properties[utf8_of(gdal().OGR_Fld_GetNameRef(field))] = value_of(feature, field, i);
  }
  return properties;
}

void add_style(OGRFeatureH feature, bool with_icons, json& properties) {
  const char* const style = gdal().OGR_F_GetStyleString(feature);
  if (style == nullptr) return;
  const std::unique_ptr<void, decltype(gdal().OGR_SM_Destroy)> styles(gdal().OGR_SM_Create(nullptr),
                                                                      gdal().OGR_SM_Destroy);
  for (int i = 0; i < gdal().OGR_SM_GetPartCount(styles.get(), style); ++i) {
    const StyleTool tool(styles.get(), i, style);
    if (tool.kind() == OGRSTCPen) {
      tool.add_colour(OGRSTPenColor, "stroke", "stroke-opacity", properties);
      tool.add_width(properties);
    } else if (tool.kind() == OGRSTCBrush) {
      tool.add_colour(OGRSTBrushFColor, "fill", "fill-opacity", properties);
    } else if (tool.kind() == OGRSTCSymbol) {
      tool.add_colour(OGRSTSymbolColor, "marker-color", nullptr, properties);
      const auto scale = icon_scale(style);
      if (scale) add_marker_size(*scale, properties);
      if (with_icons) tool.add_icon(scale.value_or(1.0), properties);
    }
  }
}

void add_times(OGRFeatureH feature, OGRFeatureDefnH definition, json& properties) {
  constexpr std::array<std::pair<const char*, const char*>, 3> kNames = {
      {{"begin", "time-begin"}, {"timestamp", "time-begin"}, {"end", "time-end"}}};
  for (const auto& [field, name] : kNames) {
    const int index = gdal().OGR_FD_GetFieldIndex(definition, field);
    if (index < 0 || properties.contains(name)) continue;
    if (const auto time_ms = milliseconds_of(feature, index)) properties[name] = *time_ms;
  }
}

}  // namespace terrella
