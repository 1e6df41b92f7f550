#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "apps/open_scene/listed_features.h"

// thread: any, for all of this header
namespace terrella {

/// Row numbers of a table in ascending order of a text, without regard to case and accents. Numbers are compared as
/// numbers and come before texts. Rows without a text are last.
struct SortOrder {
  std::vector<std::uint32_t> rows = {};
  std::size_t blank = 0;  ///< number of rows at the end without a text
};

/// Sorts texts. Rows with the same text stay in order.
[[nodiscard]] SortOrder sort_order(std::span<const std::string> texts);

/// The features of a layer as texts, one row each.
struct FeatureTable {
  std::vector<std::string> names = {};   ///< in one line; "Feature 12" without a name
  std::vector<std::string> folded = {};  ///< folded() of the name and all values
  std::vector<std::string> fields = {};  ///< fields with a value that is not the name, by name; at most kMostListFields
  SortOrder by_name = {};                ///< features without a name are blank
};

/// Most fields of a list. Further ones are searched, but cannot be chosen.
inline constexpr std::size_t kMostListFields = 200;

/// The values of one field, one for each row.
struct FieldColumn {
  std::string field = {};
  std::vector<std::string> values = {};  ///< in one line; empty without a value
  SortOrder order = {};
};

/// Reads the properties of features, about 10 µs for each. Leaves off early once `stop` is requested.
[[nodiscard]] FeatureTable read_table(std::span<const ListedFeature> features, const std::stop_token& stop = {});
/// Reads one field of features. Leaves off early once `stop` is requested.
[[nodiscard]] FieldColumn read_column(std::span<const ListedFeature> features, const std::string& field,
                                      const std::stop_token& stop = {});

}  // namespace terrella
