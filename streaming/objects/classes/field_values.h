#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "streaming/objects/feature_style.h"

namespace terrella {

/// A value of a field, and the number of features that have it.
struct FieldCategory {
  std::string value;  ///< JSON: a text, a number, true or false
  std::size_t count = 0;
  bool operator==(const FieldCategory&) const = default;
};

/// The values of a field in the features of a layer.
struct FieldValues {
  std::string name;
  bool is_numeric = true;                      ///< all values are numbers, or texts that are numbers
  std::vector<double> numbers = {};            ///< the numbers among the values
  std::vector<FieldCategory> categories = {};  ///< the most frequent first, then by value
  std::size_t missing = 0;                     ///< features without a value; an empty text is none
};

/// Most fields of a layer, and most categories of a field. Later ones are left out.
inline constexpr std::size_t kMostFieldNames = 200, kMostCategories = 1000;

/// Returns the fields of features, by name. Fields of lists and objects are left out. Costs the time to parse the
/// properties of all features. thread: any
[[nodiscard]] std::vector<FieldValues> fields_of(std::span<const FeatureParts> features);

}  // namespace terrella
