#include "streaming/objects/feature_style.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "streaming/objects/object_style.h"
#include "streaming/objects/style_rules.h"

namespace terrella {
namespace {

using nlohmann::json;

ObjectChange change_of(const FeatureParts& feature, const ObjectStyle& style) {
  ObjectChange change{.id = feature.of.id};
  if (feature.has_area) change.fill = style.polygon.fill;
  if (feature.has_label) {
    change.label = style.label.color;
    change.look = style.label.look;
  }
  change.color = feature.has_icon    ? style.point.icon.tint
                 : feature.has_point ? style.point.color
                 : feature.has_line  ? style.line.color
                                     : style.polygon.stroke;
  if (feature.has_icon) {
    change.size_px = style.icon_size_px;
    return change;
  }
  const float size_px = feature.has_point  ? style.point.size_px
                        : feature.has_line ? style.line.width_px
                                           : style.polygon.stroke_width_px;
  if (size_px > 0.0F) {
    change.size_px = size_px;
  } else {
    change.color->alpha = 0;  // a width of 0 draws no line
  }
  return change;
}

/// Reads the look of a feature in a style, with its number as the field "value".
ObjectStyle look_of(const FeatureParts& feature, const FeatureStyle& style, std::span<const double> values) {
  json fields = feature.of.feature ? json::parse(feature.of.feature->properties, nullptr, false) : json::object();
  if (!fields.is_object()) fields = json::object();
  const std::size_t k = static_cast<std::size_t>(feature.of.id) - 1;
  if (k < values.size() && std::isfinite(values[k])) fields["value"] = values[k];
  return read_object_style(applied(style, fields), [](const std::string&) {});
}

/// Properties that say when a feature is shown.
constexpr std::array<const char*, 4> kWhen = {"min-zoom", "max-zoom", "time-begin", "time-end"};

/// True for a JSON text that may have one of them.
bool may_say_when(const std::string& text) {
  return std::ranges::any_of(kWhen, [&text](const char* name) { return text.find(name) != text.npos; });
}

}  // namespace

std::vector<FeatureParts> features_of(const ObjectScene& scene) {
  std::map<ObjectId, FeatureParts> features;
  const auto take = [&features](const auto& objects, bool FeatureParts::*part) {
    for (const auto& object : objects) {
      if (object.of.id == ObjectId::none) continue;
      FeatureParts& feature = features[object.of.id];
      feature.of = object.of;
      feature.*part = true;
      if constexpr (requires { object.icon; }) feature.has_icon = feature.has_icon || object.icon.image;
    }
  };
  take(scene.points, &FeatureParts::has_point);
  take(scene.lines, &FeatureParts::has_line);
  take(scene.polygons, &FeatureParts::has_area);
  take(scene.labels, &FeatureParts::has_label);
  std::vector<FeatureParts> list;
  for (auto& [id, feature] : features) list.push_back(std::move(feature));
  return list;
}

ObjectEdits restyled(std::span<const FeatureParts> features, const FeatureStyle& style,
                     std::span<const double> values) {
  ObjectEdits edits;
  for (const FeatureParts& feature : features) {
    const ObjectStyle look = look_of(feature, style, values);
    edits.changes.push_back(change_of(feature, look));
    if (feature.has_label) edits.texts.push_back({feature.of.id, look.label.text});
  }
  return edits;
}

std::vector<ShownWhen> shown_when(std::span<const FeatureParts> features, const FeatureStyle& style,
                                  std::span<const double> values) {
  const bool by_style = !style.is_none() && std::ranges::any_of(kWhen, [&style](const char* name) {
    return style.rules().properties.contains(name);
  });
  std::vector<ShownWhen> found;
  for (const FeatureParts& feature : features) {
    if (!by_style && !(feature.of.feature && may_say_when(feature.of.feature->properties))) continue;
    ShownWhen when = look_of(feature, style, values).shown;
    when.id = feature.of.id;
    if (!is_always_shown(when)) found.push_back(when);
  }
  return found;
}

}  // namespace terrella
