#include "streaming/objects/style_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/number.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"
#include "streaming/objects/object_style.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr std::array kProperties = {"altitude-mode",
                                    "casing",
                                    "casing-width",
                                    "extrude_m",
                                    "fill",
                                    "fill-opacity",
                                    "heading_deg",
                                    "icon",
                                    "icon-anchor",
                                    "icon-color",
                                    "icon-rotate",
                                    "icon-size",
                                    "label-priority",
                                    "marker-color",
                                    "marker-size",
                                    "marker-symbol",
                                    "max-zoom",
                                    "min-zoom",
                                    "model",
                                    "radius_m",
                                    "scale",
                                    "stroke",
                                    "stroke-arrows",
                                    "stroke-width",
                                    "stroke-dasharray",
                                    "stroke-opacity",
                                    "text-anchor",
                                    "text-color",
                                    "text-font",
                                    "text-halo-blur",
                                    "text-halo-color",
                                    "text-halo-width",
                                    "text-letter-spacing",
                                    "text-size",
                                    "through_surface",
                                    "time-begin",
                                    "time-end",
                                    "title"};

/// Names of MapLibre's style specification, and those of simplestyle with the same meaning.
constexpr std::array<std::pair<const char*, const char*>, 10> kOtherNames{{{"circle-color", "marker-color"},
                                                                           {"fill-color", "fill"},
                                                                           {"fill-extrusion-height", "extrude_m"},
                                                                           {"icon-image", "icon"},
                                                                           {"line-color", "stroke"},
                                                                           {"line-opacity", "stroke-opacity"},
                                                                           {"line-width", "stroke-width"},
                                                                           {"maxzoom", "max-zoom"},
                                                                           {"minzoom", "min-zoom"},
                                                                           {"text-field", "title"}}};

/// An expression is a list that begins with a word; other lists are values, such as the lengths of dashes.
bool is_expression(const json& value) { return value.is_array() && !value.empty() && value[0].is_string(); }

bool is_operator(const json& expression, const char* name) { return expression[0] == name; }

/// Returns a fault of an expression, empty if it is right.
std::string fault_of(const json& value) {
  if (!is_expression(value)) return {};
  const std::size_t count = value.size();
  const std::string& name = value[0].get_ref<const std::string&>();
  std::size_t first = 1;  // arguments from here on are expressions
  if (name == "get") return count == 2 && value[1].is_string() ? "" : R"("get" needs the name of one field)";
  if (name == "match") {
    if (count < 5 || count % 2 == 0) return R"("match" needs an input, pairs of a value and an output, and a default)";
  } else if (name == "step") {
    if (count < 3 || count % 2 == 0) return R"("step" needs an input, an output, and pairs of a stop and an output)";
  } else if (name == "interpolate") {
    const bool has_way = count >= 5 && is_expression(value[1]);
    const bool linear = has_way && value[1] == json{"linear"};
    const bool exponential = has_way && value[1].size() == 2 && value[1][0] == "exponential" && value[1][1].is_number();
    if (!linear && !exponential)
      return R"("interpolate" needs ["linear"] or ["exponential", base], an input and stops)";
    if (count % 2 == 0) return R"("interpolate" needs pairs of a stop and an output)";
    first = 2;
  } else if (name != "coalesce" && name != "concat") {
    return fmt::format("unknown expression {}; there are get, coalesce, concat, match, step and interpolate",
                       in_quotes(name));
  }
  if (name == "step" || name == "interpolate") {
    for (std::size_t k = 3; k < count; k += 2) {
      if (!value[k].is_number()) return fmt::format("the stops of \"{}\" must be numbers", name);
      if (k > 3 && value[k] <= value[k - 2]) return fmt::format("the stops of \"{}\" must rise", name);
    }
  }
  for (std::size_t k = first; k < count; ++k) {
    const bool is_label = name == "match" && k >= 2 && k % 2 == 0 && k + 1 < count;
    if (is_label) continue;
    if (std::string fault = fault_of(value[k]); !fault.empty()) return fault;
  }
  return {};
}

/// Returns a value between two, numbers or colours; null for others.
json between(const json& low, const json& high, double part) {
  const auto mix = [part](double a, double b) { return a + part * (b - a); };
  if (low.is_number() && high.is_number()) return mix(low.get<double>(), high.get<double>());
  if (!low.is_string() || !high.is_string()) return {};
  const auto a = read_color(low.get_ref<const std::string&>()), b = read_color(high.get_ref<const std::string&>());
  if (!a || !b) return {};
  const auto channel = [&](std::uint8_t one, std::uint8_t other) {
    return static_cast<std::uint8_t>(std::lround(mix(one, other)));
  };
  return color_text({channel(a->red, b->red), channel(a->green, b->green), channel(a->blue, b->blue)});
}

/// Computes checked expressions over the fields of one feature.
class Evaluation {
 public:
  explicit Evaluation(const json& fields) : fields_(fields) {}

  /// Returns null where an expression has no value.
  json value(const json& said) const {
    if (!is_expression(said)) return said;
    if (is_operator(said, "get")) return field(said[1].get_ref<const std::string&>());
    if (is_operator(said, "match")) return match(said);
    if (is_operator(said, "step")) return step(said);
    if (is_operator(said, "interpolate")) return interpolate(said);
    return is_operator(said, "concat") ? concat(said) : coalesce(said);
  }

 private:
  json field(const std::string& name) const {
    const auto found = fields_.find(name);
    return fields_.is_object() && found != fields_.end() ? *found : json();
  }

  json coalesce(const json& said) const {
    for (std::size_t k = 1; k < said.size(); ++k) {
      if (json one = value(said[k]); !one.is_null()) return one;
    }
    return {};
  }

  json concat(const json& said) const {
    std::string text;
    for (std::size_t k = 1; k < said.size(); ++k) {
      const json one = value(said[k]);
      if (!one.is_null()) text += one.is_string() ? one.get<std::string>() : one.dump();
    }
    return text;
  }

  json match(const json& said) const {
    const json input = value(said[1]);
    for (std::size_t k = 2; k + 1 < said.size(); k += 2) {
      const bool one_of = said[k].is_array() && std::ranges::find(said[k], input) != said[k].end();
      if (one_of || said[k] == input) return value(said[k + 1]);
    }
    return value(said.back());
  }

  json step(const json& said) const {
    const std::optional<double> input = number_of(value(said[1]));
    if (!input) return {};
    std::size_t output = 2;
    for (std::size_t k = 3; k < said.size() && *input >= said[k].get<double>(); k += 2) output = k + 1;
    return value(said[output]);
  }

  json interpolate(const json& said) const {
    const std::optional<double> input = number_of(value(said[2]));
    if (!input) return {};
    std::size_t above = 3;
    while (above < said.size() && *input >= said[above].get<double>()) above += 2;
    if (above == 3) return value(said[4]);
    if (above >= said.size()) return value(said.back());
    const double low = said[above - 2].get<double>(), high = said[above].get<double>();
    const double base = said[1].size() == 2 ? said[1][1].get<double>() : 1.0;
    const double part = base == 1.0 ? (*input - low) / (high - low)
                                    : (std::pow(base, *input - low) - 1.0) / (std::pow(base, high - low) - 1.0);
    return between(value(said[above - 1]), value(said[above + 1]), part);
  }

  const json& fields_;
};

}  // namespace

std::optional<double> number_of(const json& value) {
  if (value.is_number()) return value.get<double>();
  return value.is_string() ? read_number(value.get_ref<const std::string&>()) : std::nullopt;
}

Result<FeatureStyle> FeatureStyle::parse(std::string_view text, const std::string& where) {
  const Result<json> said = parse_json_object(text, kMaxStyleBytes, where);
  if (!said) return said.error();
  json properties = json::object();
  for (const auto& [name, value] : said->items()) {
    const auto other = std::ranges::find(kOtherNames, name, [](const auto& pair) { return pair.first; });
    const std::string known = other != kOtherNames.end() ? other->second : name;
    if (std::ranges::find(kProperties, known) == kProperties.end()) {
      return Error{
          fmt::format("{}: unknown property {}; there are {}", where, in_quotes(name), fmt::join(kProperties, ", "))};
    }
    if (properties.contains(known)) return Error{fmt::format("{}: {} is there twice", where, in_quotes(known))};
    const std::string fault = fault_of(value);
    // The names of fonts look like an expression that does not exist. The first one counts.
    const bool is_list_of_fonts = known == "text-font" && fault.starts_with("unknown expression") &&
                                  std::ranges::all_of(value, [](const json& one) { return one.is_string(); });
    if (!fault.empty() && !is_list_of_fonts) {
      return Error{fmt::format("{}: {}: {}", where, in_quotes(name), fault)};
    }
    properties[known] = is_list_of_fonts ? value.front() : value;
  }
  FeatureStyle style;
  style.rules_ = std::make_shared<const Rules>(Rules{std::move(properties)});
  return style;
}

Result<FeatureStyle> FeatureStyle::load(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMaxStyleBytes);
  if (!bytes) return Error{bytes.error().message};
  return parse(as_text(*bytes), file.string());
}

json applied(const FeatureStyle& style, const json& fields) {
  json result = fields.is_object() ? fields : json::object();
  if (style.is_none()) return result;
  const Evaluation evaluation(fields);
  for (const auto& [name, said] : style.rules().properties.items()) result[name] = evaluation.value(said);
  return result;
}

}  // namespace terrella
