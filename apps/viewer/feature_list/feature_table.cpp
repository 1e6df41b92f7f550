#include "apps/viewer/feature_list/feature_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "apps/viewer/balloon/object_fields.h"
#include "apps/viewer/tools/folded_text.h"
#include "base/number.h"

namespace terrella {
namespace {

/// A text as it is sorted.
struct SortKey {
  bool blank = true;
  std::optional<double> number;
  std::string folded;

  [[nodiscard]] bool operator<(const SortKey& other) const {
    if (blank != other.blank) return other.blank;
    if (number.has_value() != other.number.has_value()) return number.has_value();
    return number ? *number < *other.number : folded < other.folded;
  }
};

SortKey key_of(const std::string& text) {
  SortKey key{.blank = text.empty(), .number = read_number(text), .folded = {}};
  if (!key.number) key.folded = folded(text);
  return key;
}

std::string_view properties_of(const ListedFeature& feature) {
  return feature.of.feature ? std::string_view(feature.of.feature->properties) : std::string_view();
}

std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return text;
}

/// All texts of a feature, with line ends between them, so that no text of a filter spans two.
std::string all_texts(const std::string& name, const ObjectFields& fields) {
  std::string texts = name;
  for (const ObjectField& field : fields.rows) texts.append("\n").append(in_one_line(field.value));
  return texts;
}

}  // namespace

SortOrder sort_order(std::span<const std::string> texts) {
  std::vector<SortKey> keys;
  keys.reserve(texts.size());
  std::ranges::transform(texts, std::back_inserter(keys), key_of);
  SortOrder order;
  order.rows.resize(texts.size());
  std::iota(order.rows.begin(), order.rows.end(), 0U);
  std::ranges::stable_sort(order.rows, [&keys](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  order.blank = static_cast<std::size_t>(std::ranges::count(keys, true, &SortKey::blank));
  return order;
}

FeatureTable read_table(std::span<const ListedFeature> features, const std::stop_token& stop) {
  FeatureTable table;
  std::vector<std::string> titles;
  std::set<std::string> fields;
  for (const ListedFeature& feature : features) {
    if (stop.stop_requested()) return table;
    const ObjectFields read = object_fields(properties_of(feature));
    titles.push_back(in_one_line(read.title));
    table.names.push_back(titles.back().empty() ? fmt::format("Feature {}", std::uint64_t(feature.of.id))
                                                : titles.back());
    table.folded.push_back(folded(all_texts(table.names.back(), read)));
    for (const ObjectField& field : read.rows) {
      if (fields.size() < kMostListFields && field.name != "...") fields.insert(field.name);
    }
  }
  table.fields.assign(fields.begin(), fields.end());
  table.by_name = sort_order(titles);
  return table;
}

FieldColumn read_column(std::span<const ListedFeature> features, const std::string& field,
                        const std::stop_token& stop) {
  FieldColumn column{.field = field};
  for (const ListedFeature& feature : features) {
    if (stop.stop_requested()) return column;
    column.values.push_back(in_one_line(object_field(properties_of(feature), field)));
  }
  column.order = sort_order(column.values);
  return column;
}

}  // namespace terrella
