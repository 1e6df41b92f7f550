#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"
#include "streaming/objects/feature_style.h"

namespace terrella {

/// Colour of features without a value, and of those in none of the categories.
inline constexpr ObjectColor kRestColor{138, 138, 138};

/// The colours that a style sets.
struct StyleTargets {
  bool fill = false;    ///< areas
  bool stroke = false;  ///< lines, and the edges of areas
  bool marker = false;  ///< points
  bool icon = false;    ///< icons
  bool operator==(const StyleTargets&) const = default;
};

/// Returns the colours that show the features: edges of areas keep theirs if the features have no lines.
[[nodiscard]] StyleTargets targets_of(std::span<const FeatureParts> features);

/// Colours by the classes of one field. Without categories, class k holds the numbers from stops[k - 1] on.
struct ClassStyle {
  std::string field;
  std::vector<double> stops = {};            ///< ascending, one less than colours; for classes of numbers
  std::vector<std::string> categories = {};  ///< JSON values; one for each colour
  std::vector<ObjectColor> colors = {};      ///< alpha is not used
  std::optional<ObjectColor> rest = {};      ///< colour of all other features; categories always have one
  StyleTargets targets = {};
  bool operator==(const ClassStyle&) const = default;
};

/// Writes the style as --object-style reads it: "step" for numbers, "match" for categories. thread: any
[[nodiscard]] std::string style_text(const ClassStyle& style);
/// Returns the classes of a style that style_text() could have written among other properties; nullopt for other
/// styles. thread: any
[[nodiscard]] std::optional<ClassStyle> classes_of(const FeatureStyle& style);

/// Returns a style with the properties of another one, given as text, in place of its own. thread: any
[[nodiscard]] Result<FeatureStyle> overlaid(const FeatureStyle& style, std::string_view over);
/// Writes a style as --object-style reads it, an empty object for no style. thread: any
[[nodiscard]] std::string style_text(const FeatureStyle& style);

}  // namespace terrella
