#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "streaming/objects/classes/class_style.h"
#include "streaming/objects/classes/field_values.h"

// thread: any, for all of this header
namespace terrella {

/// Kinds of classes in the order of the panel's list. The first ones are those of ClassKind.
enum class StyleClasses { equal, quantile, jenks, categories };
inline constexpr std::array kStyleClasses{"equal intervals", "quantiles", "natural (Jenks)", "categories"};

inline constexpr int kLeastStyleClasses = 2;

/// The user's choice for the colours of a layer.
struct StyleChoice {
  std::string field = {};  ///< empty: the features have their own style
  StyleClasses kind = StyleClasses::quantile;
  std::string colormap = "viridis";
  int classes = 5;  ///< kLeastStyleClasses to kMostClasses
  bool reversed = false;
  bool operator==(const StyleChoice&) const = default;
};

/// Returns `count` colours of a map with even distances, both ends included; one colour is that of the middle.
[[nodiscard]] std::vector<ObjectColor> class_colors(const std::string& colormap, std::size_t count, bool reversed);

/// Returns the field of a choice; null if the layer does not have the field.
[[nodiscard]] const FieldValues* chosen_field(const StyleChoice& choice, std::span<const FieldValues> fields);

/// Returns a choice that suits its field: texts have categories.
[[nodiscard]] StyleChoice suited(StyleChoice choice, const FieldValues& field);

/// Returns the classes and colours of a choice. A field without values has none.
[[nodiscard]] ClassStyle style_of(const StyleChoice& choice, const FieldValues& field, const StyleTargets& targets);

}  // namespace terrella
