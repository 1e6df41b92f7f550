#include "streaming/objects/classes/field_values.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "streaming/objects/style_rules.h"

namespace terrella {
namespace {

using nlohmann::json;

/// A field while its values are collected.
struct Field {
  FieldValues values;
  std::unordered_map<std::string, std::size_t> counts;
  std::size_t present = 0;
};

/// True for a value that a class or a category can have.
bool has_value(const json& value) {
  if (value.is_string()) return !value.get_ref<const std::string&>().empty();
  return value.is_primitive() && !value.is_null();
}

void take(Field& field, const json& value) {
  ++field.present;
  const auto number = number_of(value);
  if (number) field.values.numbers.push_back(*number);
  if (!number) field.values.is_numeric = false;
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (field.counts.size() < kMostCategories || field.counts.contains(text)) ++field.counts[std::move(text)];
}

FieldValues finished(const std::string& name, Field field, std::size_t features) {
  FieldValues values = std::move(field.values);
  values.name = name;
  values.missing = features - field.present;
  values.categories.reserve(field.counts.size());
  for (const auto& [value, count] : field.counts) values.categories.push_back({value, count});
  std::ranges::sort(values.categories, [](const FieldCategory& a, const FieldCategory& b) {
    return a.count != b.count ? a.count > b.count : a.value < b.value;
  });
  return values;
}

}  // namespace

std::vector<FieldValues> fields_of(std::span<const FeatureParts> features) {
  std::map<std::string, Field> fields;
  for (const FeatureParts& feature : features) {
    if (!feature.of.feature) continue;
    const json properties = json::parse(feature.of.feature->properties, nullptr, false);
    if (!properties.is_object()) continue;
    for (const auto& [name, value] : properties.items()) {
      if (!has_value(value) || (fields.size() >= kMostFieldNames && !fields.contains(name))) continue;
      take(fields[name], value);
    }
  }
  std::vector<FieldValues> all;
  all.reserve(fields.size());
  for (auto& [name, field] : fields) all.push_back(finished(name, std::move(field), features.size()));
  return all;
}

}  // namespace terrella
