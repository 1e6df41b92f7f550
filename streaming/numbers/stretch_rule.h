#pragma once

#include <string>

#include "base/result.h"
#include "streaming/numbers/number_statistics.h"
#include "streaming/numbers/stretch.h"

// thread: any, for all of this header
namespace terrella {

/// Choice of the first and the last shown value.
struct StretchRule {
  enum class Kind {
    range,    ///< `low` to `high`, in values
    min_max,  ///< all values
    percent,  ///< the percentiles `low` and `high`
    sigma,    ///< the mean minus and plus `high` standard deviations
  };
  Kind kind = Kind::percent;
  double low = 2.0;
  double high = 98.0;
  bool operator==(const StretchRule&) const = default;
};

/// Reads "MIN,MAX", "minmax", "percent:PA,PB", "PA-PB" (percentiles), "sigma:N" or "auto" (percent:2,98). The error
/// names the text and says what is accepted.
[[nodiscard]] Result<StretchRule> parse_stretch(const std::string& text);

/// Writes a rule so that parse_stretch() reads it.
[[nodiscard]] std::string stretch_text(const StretchRule& rule);

/// Applies the rule. `low` is always less than `high`: a raster of one value gets a range around it.
[[nodiscard]] Stretch stretch_by(const StretchRule& rule, const NumberStatistics& statistics);

}  // namespace terrella
