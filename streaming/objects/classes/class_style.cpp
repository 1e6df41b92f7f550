#include "streaming/objects/classes/class_style.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "streaming/json_fields.h"
#include "streaming/objects/object_style.h"
#include "streaming/objects/style_rules.h"

namespace terrella {
namespace {

using nlohmann::json;

json step_of(const ClassStyle& style) {
  json step = {"step", {"get", style.field}};
  for (std::size_t k = 0; k < style.colors.size(); ++k) {
    if (k > 0) step.push_back(style.stops[k - 1]);
    step.push_back(color_text(style.colors[k]));
  }
  return style.rest ? json{"coalesce", std::move(step), color_text(*style.rest)} : step;
}

json match_of(const ClassStyle& style) {
  json match = {"match", {"get", style.field}};
  for (std::size_t k = 0; k < style.colors.size(); ++k) {
    match.push_back(json::parse(style.categories[k], nullptr, false));
    match.push_back(color_text(style.colors[k]));
  }
  match.push_back(color_text(style.rest.value_or(kRestColor)));
  return match;
}

constexpr std::pair<const char*, bool StyleTargets::*> kTargets[] = {{"fill", &StyleTargets::fill},
                                                                     {"stroke", &StyleTargets::stroke},
                                                                     {"marker-color", &StyleTargets::marker},
                                                                     {"icon-color", &StyleTargets::icon}};

std::optional<ObjectColor> color_of(const json& value) {
  return value.is_string() ? read_color(value.get_ref<const std::string&>()) : std::nullopt;
}

bool begins_with(const json& value, const char* name) { return value.is_array() && !value.empty() && value[0] == name; }

/// Reads classes from a checked "step" or "match": colours stand at every other place from `first` on.
std::optional<ClassStyle> read_classes(const json& said, std::size_t first, std::size_t end) {
  ClassStyle style;
  if (!begins_with(said[1], "get")) return std::nullopt;
  style.field = said[1][1].get<std::string>();
  style.colors.reserve(said.size());
  for (std::size_t k = first; k < end; k += 2) {
    const auto color = color_of(said[k]);
    if (!color) return std::nullopt;
    style.colors.push_back(*color);
  }
  return style;
}

std::optional<ClassStyle> read_step(const json& said) {
  auto style = read_classes(said, 2, said.size());
  if (style) style->stops.reserve(said.size());
  for (std::size_t k = 3; style && k < said.size(); k += 2) style->stops.push_back(said[k].get<double>());
  return style;
}

std::optional<ClassStyle> read_match(const json& said) {
  auto style = read_classes(said, 3, said.size() - 1);
  const auto rest = color_of(said.back());
  if (!style || !rest) return std::nullopt;
  style->rest = rest;
  style->categories.reserve(said.size());
  for (std::size_t k = 2; k + 1 < said.size(); k += 2) {
    style->categories.push_back(said[k].dump(-1, ' ', false, json::error_handler_t::replace));
  }
  return style;
}

std::optional<ClassStyle> read_expression(const json& said) {
  if (begins_with(said, "match")) return read_match(said);
  if (begins_with(said, "step")) return read_step(said);
  if (!begins_with(said, "coalesce") || said.size() != 3 || !begins_with(said[1], "step")) return std::nullopt;
  auto style = read_step(said[1]);
  const auto rest = color_of(said[2]);
  if (!style || !rest) return std::nullopt;
  style->rest = rest;
  return style;
}

}  // namespace

StyleTargets targets_of(std::span<const FeatureParts> features) {
  StyleTargets targets;
  for (const FeatureParts& feature : features) {
    targets.fill |= feature.has_area;
    targets.stroke |= feature.has_line;
    targets.icon |= feature.has_icon;
    targets.marker |= feature.has_point && !feature.has_icon;
  }
  return targets;
}

std::string style_text(const ClassStyle& style) {
  json properties = json::object();
  if (style.colors.empty()) return properties.dump();
  const json colors = style.categories.empty() ? step_of(style) : match_of(style);
  for (const auto& [name, is_set] : kTargets) {
    if (style.targets.*is_set) properties[name] = colors;
  }
  return properties.dump(2, ' ', false, json::error_handler_t::replace);
}

std::optional<ClassStyle> classes_of(const FeatureStyle& style) {
  if (style.is_none()) return std::nullopt;
  const json& properties = style.rules().properties;
  std::optional<ClassStyle> found;
  json first;
  for (const auto& [name, is_set] : kTargets) {
    const auto said = properties.find(name);
    if (said == properties.end() || (found && *said != first)) continue;
    if (!found) {
      found = read_expression(*said);
      first = *said;
    }
    if (found) found->targets.*is_set = true;
  }
  return found;
}

Result<FeatureStyle> overlaid(const FeatureStyle& style, std::string_view over) {
  const std::string where = "style";
  Result<json> more = parse_json_object(over, kMaxStyleBytes, where);
  if (!more) return more.error();
  json all = style.is_none() ? json::object() : style.rules().properties;
  all.update(*more);
  return FeatureStyle::parse(all.dump(-1, ' ', false, json::error_handler_t::replace), where);
}

std::string style_text(const FeatureStyle& style) {
  const json none = json::object();
  const json& properties = style.is_none() ? none : style.rules().properties;
  return properties.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace terrella
