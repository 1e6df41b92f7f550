#include "streaming/objects/object_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <tuple>

#include "base/iso_time.h"
#include "base/number.h"
#include "base/utc_time.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr int kLeastMarker_px = 1, kMostMarker_px = 256;

/// Reads the properties of one feature. A faulty property causes a complaint and counts as missing.
class StyleReader {
 public:
  StyleReader(const json& properties, const Complain& complain) : properties_(properties), complain_(complain) {}

  std::optional<ObjectColor> color(const char* name) const {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    const auto color = value->is_string() ? read_color(value->get_ref<const std::string&>()) : std::nullopt;
    if (!color) complain_(fmt::format("\"{}\" is not a colour; #rgb or #rrggbb is needed", name));
    return color;
  }

  std::optional<double> number(const char* name, double least, double most) const {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    if (value->is_number()) {
      const double number = value->get<double>();
      if (number >= least && number <= most) return number;
    }
    complain_(fmt::format("\"{}\" must be a number from {} to {}", name, least, most));
    return std::nullopt;
  }

  /// Lengths of dashes and gaps, as in Leaflet and SVG.
  LineDashes dashes() const {
    const json* value = find("stroke-dasharray");
    if (value == nullptr) return {};
    constexpr double kMost_px = 1000.0;
    std::array<double, 2> lengths{};
    const bool is_pair = value->is_array() && value->size() == 2;
    for (std::size_t k = 0; is_pair && k < 2; ++k) {
      if ((*value)[k].is_number()) lengths[k] = (*value)[k].get<double>();
    }
    const auto good = [](double length) { return length > 0.0 && length <= kMost_px; };
    if (good(lengths[0]) && good(lengths[1])) return {static_cast<float>(lengths[0]), static_cast<float>(lengths[1])};
    complain_("\"stroke-dasharray\" must be two lengths, [dash, gap], each up to 1000 px");
    return {};
  }

  /// Ends of a line that have arrows.
  std::pair<bool, bool> arrows() const {
    const json* value = find("stroke-arrows");
    if (value == nullptr) return {};
    constexpr std::array<std::pair<const char*, std::pair<bool, bool>>, 3> kEnds{
        {{"start", {true, false}}, {"end", {false, true}}, {"both", {true, true}}}};
    for (const auto& [name, ends] : kEnds) {
      if (*value == name) return ends;
    }
    complain_("\"stroke-arrows\" must be start, end or both");
    return {};
  }

  bool flag(const char* name) const {
    const json* value = find(name);
    if (value == nullptr) return false;
    if (value->is_boolean()) return value->get<bool>();
    complain_(fmt::format("\"{}\" must be true or false", name));
    return false;
  }

  std::optional<float> marker_size() const {
    const json* value = find("marker-size");
    if (value == nullptr) return std::nullopt;
    constexpr std::array<std::pair<const char*, float>, 3> kSizes_px{{{"small", 7}, {"medium", 10}, {"large", 14}}};
    for (const auto& [name, size] : kSizes_px) {
      if (*value == name) return size;
    }
    if (value->is_number() && *value >= kLeastMarker_px && *value <= kMostMarker_px) return value->get<float>();
    complain_(
        fmt::format("\"marker-size\" must be small, medium, large, or {} to {} px", kLeastMarker_px, kMostMarker_px));
    return std::nullopt;
  }

  /// Names of KML. None if the feature says nothing.
  std::optional<HeightMode> height_mode() const {
    const json* value = find("altitude-mode");
    if (value == nullptr) return std::nullopt;
    if (*value == "absolute") return HeightMode::absolute;
    if (*value == "clampToGround") return HeightMode::clamp_to_ground;
    if (*value == "relativeToGround") return HeightMode::relative_to_ground;
    complain_("\"altitude-mode\" must be absolute, clampToGround or relativeToGround");
    return std::nullopt;
  }

  /// Text of a property that simplestyle does not define. Another type causes no complaint, because other programs may
  /// use the name differently.
  std::string text(const char* name) const {
    const json* value = find(name);
    return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
  }

  std::string simplestyle_text(const char* name) const {
    const json* value = find(name);
    if (value != nullptr && !value->is_string()) complain_(fmt::format("\"{}\" must be a text", name));
    return text(name);
  }

  /// A part of an icon or a text, in the words of MapLibre's anchors.
  std::optional<TextAnchor> anchor(const char* property) const {
    const json* value = find(property);
    if (value == nullptr) return std::nullopt;
    constexpr std::array<const char*, 9> kAnchors = {"center",   "left",      "right",       "top",         "bottom",
                                                     "top-left", "top-right", "bottom-left", "bottom-right"};
    for (std::size_t k = 0; k < kAnchors.size(); ++k) {
      if (*value == kAnchors[k]) return TextAnchor(k);
    }
    complain_(
        fmt::format("\"{}\" must be center, left, right, top, bottom, or a corner such as bottom-left", property));
    return std::nullopt;
  }

  /// Weight and slant by the words in a font's name, as MapLibre's styles have it. The first font of a list counts.
  void font(LabelLook& look) const {
    const json* value = find("text-font");
    if (value != nullptr && value->is_array() && !value->empty()) value = &value->front();
    if (value == nullptr) return;
    if (!value->is_string()) return complain_("\"text-font\" must be a font's name, such as Noto Sans Bold Italic");
    std::string name = value->get<std::string>();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    static const std::regex light("(^|[ -])(extra|semi|demi|ultra)?(light|thin)(italic|oblique)?($|[ -])");
    static const std::regex bold("(^|[ -])(extra|semi|demi|ultra)?(bold|black|heavy)(italic|oblique)?($|[ -])");
    static const std::regex slanted("(italic|oblique)($|[ -])");
    if (std::regex_search(name, light)) look.weight = TextWeight::light;
    if (std::regex_search(name, bold)) look.weight = TextWeight::bold;
    look.slanted = std::regex_search(name, slanted);
  }

  /// An instant of ISO 8601, also a year or a month alone, or with the slashes of GDAL; or milliseconds since 1970.
  std::optional<UtcTime> instant(const char* name) const {
    constexpr double kMost_ms = 2.5e14;  // the year 9892
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    if (value->is_number() && std::abs(value->get<double>()) < kMost_ms) {
      return UtcTime(std::chrono::milliseconds(std::llround(value->get<double>())));
    }
    std::string said = text(name);
    std::ranges::replace(said, '/', '-');
    std::ranges::replace(said, ' ', 'T');
    if (said.ends_with("+00")) said.resize(said.size() - 3);
    if (const auto time = read_named_time(said)) return time->from;
    complain_(
        fmt::format("\"{}\" must be an instant in UTC, such as 2026-06-21T12:00Z, or milliseconds since 1970", name));
    return std::nullopt;
  }

  /// A digit or a letter. Empty for the name of an icon: there are no icons by name.
  std::string marker_symbol() const {
    const json* value = find("marker-symbol");
    if (value == nullptr) return {};
    if (value->is_number_unsigned() && value->get<std::uint64_t>() < 10) return value->dump();
    if (!value->is_string()) {
      complain_("\"marker-symbol\" must be a digit, a letter or an icon's name");
      return {};
    }
    const auto& symbol = value->get_ref<const std::string&>();
    const bool drawn =
        symbol.size() == 1 && ((symbol[0] >= '0' && symbol[0] <= '9') || (symbol[0] >= 'a' && symbol[0] <= 'z'));
    if (drawn || symbol.empty()) return symbol;
    if (text("icon").empty()) {
      complain_(
          fmt::format("\"marker-symbol\" {}: there are no icons by name; give a picture file as \"icon\". A disc is "
                      "drawn",
                      in_quotes(symbol)));
    }
    return {};
  }

 private:
  const json* find(const char* name) const {
    if (!properties_.is_object()) return nullptr;
    const auto found = properties_.find(name);
    return found == properties_.end() || found->is_null() ? nullptr : &*found;
  }

  const json& properties_;
  const Complain& complain_;
};

void set_opacity(ObjectColor& color, std::optional<double> opacity) {
  if (opacity) color.alpha = static_cast<std::uint8_t>(std::lround(255.0 * *opacity));
}

/// Sets a colour, but not its opacity.
void set_color(ObjectColor& color, std::optional<ObjectColor> said) {
  if (said) color = {said->red, said->green, said->blue, color.alpha};
}

void read_line(const StyleReader& reader, double most_px, LineObject& line) {
  line.dashes = reader.dashes();
  if (const auto width = reader.number("casing-width", 0.0, most_px)) line.casing_px = static_cast<float>(*width);
  set_color(line.casing, reader.color("casing"));
  std::tie(line.arrow_at_start, line.arrow_at_end) = reader.arrows();
}

/// Reads the look of a text. A halo in a colour that is given is opaque.
void read_text(const StyleReader& reader, LabelObject& label) {
  set_color(label.color, reader.color("text-color"));
  LabelLook& look = label.look;
  if (const auto size = reader.number("text-size", kLeastText_px, kMostText_px)) {
    look.text_px = static_cast<float>(*size);
  }
  look.halo = reader.color("text-halo-color").value_or(look.halo);
  if (const auto width = reader.number("text-halo-width", 0.0, kMostHalo_px)) look.halo_px = static_cast<float>(*width);
  if (const auto blur = reader.number("text-halo-blur", 0.0, kMostHalo_px)) {
    look.halo_blur_px = static_cast<float>(*blur);
  }
  look.anchor = reader.anchor("text-anchor").value_or(look.anchor);
  if (const auto spacing = reader.number("text-letter-spacing", 0.0, 1.0)) {
    look.letter_spacing_em = static_cast<float>(*spacing);
  }
  reader.font(look);
}

/// Reads when a feature is shown. Bounds in the wrong order would hide it for ever.
ShownWhen read_shown(const StyleReader& reader, const Complain& complain) {
  ShownWhen when{.from = reader.instant("time-begin"), .before = reader.instant("time-end")};
  when.from_zoom = reader.number("min-zoom", kLeastZoom, kMostZoom).value_or(kLeastZoom);
  when.before_zoom = reader.number("max-zoom", kLeastZoom, kMostZoom).value_or(kMostZoom);
  if (when.from_zoom >= when.before_zoom) {
    complain("\"min-zoom\" must be less than \"max-zoom\"");
    when.from_zoom = kLeastZoom;
    when.before_zoom = kMostZoom;
  }
  if (when.from && when.before && *when.from >= *when.before) {
    complain("\"time-begin\" must be before \"time-end\"");
    when.from = when.before = std::nullopt;
  }
  return when;
}

/// Reads an icon. Other programs may use its properties differently without one.
void read_icon(const StyleReader& reader, ObjectStyle& style) {
  constexpr double kMostSize_px = 1024.0;
  style.icon = reader.text("icon");
  if (style.icon.empty()) return;
  PointIcon& icon = style.point.icon;
  if (const auto size = reader.number("icon-size", 1.0, kMostSize_px)) style.icon_size_px = static_cast<float>(*size);
  if (const auto anchor = reader.anchor("icon-anchor")) icon.anchor = part_at(*anchor);
  icon.tint = reader.color("icon-color").value_or(icon.tint);
  if (const auto turn = reader.number("icon-rotate", -360.0, 360.0)) icon.heading = Angle::degrees(*turn);
  if (const auto heading = reader.number("heading_deg", -360.0, 360.0)) {
    icon.heading = Angle::degrees(*heading);
    icon.from_north = true;
  }
}

/// Defaults of simplestyle 1.1.0, section 3. The specification gives no size for "medium"; this one is Terrella's.
ObjectStyle simplestyle_defaults() {
  constexpr ObjectColor kMarker{0x7e, 0x7e, 0x7e}, kStroke{0x55, 0x55, 0x55}, kFill{0x55, 0x55, 0x55, 153};  // 0.6
  ObjectStyle style;
  style.point.color = kMarker;
  style.line.color = style.polygon.stroke = kStroke;
  style.line.width_px = style.polygon.stroke_width_px = 2.0F;
  style.polygon.fill = kFill;
  return style;
}

}  // namespace

std::string color_text(const ObjectColor& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue);
}

std::optional<ObjectColor> read_color(std::string_view text) {
  if (text.starts_with('#')) text.remove_prefix(1);
  unsigned value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  const auto part = [value](unsigned shift, unsigned mask, unsigned scale) {
    return static_cast<std::uint8_t>((value >> shift & mask) * scale);
  };
  if (text.size() == 3) return ObjectColor{part(8, 15, 17), part(4, 15, 17), part(0, 15, 17)};
  if (text.size() == 6) return ObjectColor{part(16, 255, 1), part(8, 255, 1), part(0, 255, 1)};
  return std::nullopt;
}

ObjectStyle read_object_style(const json& properties, const Complain& complain) {
  constexpr double kMostLength_m = 1.0e9, kMostWidth_px = 256.0, kLeastScale = 1.0e-6, kMostScale = 1.0e6;
  const StyleReader reader(properties, complain);
  ObjectStyle style = simplestyle_defaults();
  set_color(style.point.color, reader.color("marker-color"));
  if (const auto size = reader.marker_size()) style.point.size_px = *size;
  if (const auto radius = reader.number("radius_m", 0.0, kMostLength_m)) style.point.radius_m = *radius;
  const auto stroke = reader.color("stroke");
  const auto stroke_opacity = reader.number("stroke-opacity", 0.0, 1.0);
  const auto stroke_width = reader.number("stroke-width", 0.0, kMostWidth_px);
  for (ObjectColor* color : {&style.line.color, &style.polygon.stroke}) {
    set_color(*color, stroke);
    set_opacity(*color, stroke_opacity);
  }
  if (stroke_width) style.line.width_px = style.polygon.stroke_width_px = static_cast<float>(*stroke_width);
  read_line(reader, kMostWidth_px, style.line);
  set_color(style.polygon.fill, reader.color("fill"));
  set_opacity(style.polygon.fill, reader.number("fill-opacity", 0.0, 1.0));
  style.polygon.extrude_m = reader.number("extrude_m", 0.0, kMostLength_m).value_or(0.0);
  const bool through = reader.flag("through_surface");
  read_icon(reader, style);
  style.model = reader.text("model");
  if (!style.model.empty()) {  // other programs may use these names differently
    if (const auto scale = reader.number("scale", kLeastScale, kMostScale)) style.mesh.scale = *scale;
    if (const auto heading = reader.number("heading_deg", -360.0, 360.0)) style.mesh.heading = Angle::degrees(*heading);
  }
  style.mesh.through_surface = style.point.through_surface = style.line.through_surface =
      style.polygon.through_surface = through;
  style.heights = reader.height_mode();
  static_cast<void>(reader.simplestyle_text("description"));
  const std::string symbol = reader.marker_symbol();
  style.label.text = reader.simplestyle_text("title");
  if (style.label.text.empty()) style.label.text = reader.text("name");
  if (style.label.text.empty()) style.label.text = symbol;
  if (const auto priority = reader.number("label-priority", -1e9, 1e9)) style.label.priority = *priority;
  read_text(reader, style.label);
  style.shown = read_shown(reader, complain);
  return style;
}

}  // namespace terrella
