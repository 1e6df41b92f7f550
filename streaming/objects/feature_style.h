#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geo/object_edits.h"
#include "geo/shown_when.h"

namespace terrella {

/// A longer style file is refused.
inline constexpr std::size_t kMaxStyleBytes = 1UL << 20;

/// A style of vector layers. It gives properties that draw features (streaming/objects/README.md) a value, or an
/// expression over the feature's fields. Names are those of simplestyle 1.1.0, some also by MapLibre's names;
/// expressions are a subset of MapLibre's: get, coalesce, concat, match, step and interpolate (linear, exponential). A
/// property whose expression has no value, because a field is missing or of another kind, has its default. thread: any
class FeatureStyle {
 public:
  /// Parses a JSON object of properties. The error begins with `where` and names the property and a cure.
  [[nodiscard]] static Result<FeatureStyle> parse(std::string_view text, const std::string& where);
  [[nodiscard]] static Result<FeatureStyle> load(const std::filesystem::path& file);

  /// True for no style, the default: features are drawn by their own properties.
  [[nodiscard]] bool is_none() const { return rules_ == nullptr; }

  struct Rules;  ///< checked expressions, not public
  /// Not for no style.
  [[nodiscard]] const Rules& rules() const { return *rules_; }

 private:
  std::shared_ptr<const Rules> rules_;
};

/// The parts of a feature that another style changes without reading it again.
struct FeatureParts {
  ObjectIdentity of = {};
  bool has_point = false, has_icon = false, has_line = false, has_area = false, has_label = false;
};

/// Returns the features of a scene that have an id, in ascending order of ids. thread: any
[[nodiscard]] std::vector<FeatureParts> features_of(const ObjectScene& scene);

/// Returns the edits that give features another style: colours, opacities, sizes of markers, widths of lines, texts and
/// looks of labels. Heights, icons, dashes and arrows stay, and labels of features that had none do not come.
/// `values[k]` is the field "value" of the feature with the id k + 1, none if it is not finite. Faulty properties have
/// their defaults. The colour of a feature of several kinds is that of its point, or else of its line. thread: any
[[nodiscard]] ObjectEdits restyled(std::span<const FeatureParts> features, const FeatureStyle& style,
                                   std::span<const double> values = {});

/// Returns the features that are not always shown in a style, or by their own properties for no style. `values` are
/// those of restyled(). thread: any
[[nodiscard]] std::vector<ShownWhen> shown_when(std::span<const FeatureParts> features, const FeatureStyle& style,
                                                std::span<const double> values = {});

}  // namespace terrella
