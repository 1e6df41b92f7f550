#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace terrella {

/// Checks values of a caller one after the other and keeps the first that is out of range. The error names the value,
/// says what it is, and what to give. NaN is out of every range. thread: any
class RangeCheck {
 public:
  static constexpr double kMost = std::numeric_limits<double>::max();

  /// `low` ≤ value ≤ `high`, to within `rounding`.
  RangeCheck& in(std::string_view name, double value, double low, double high, std::string_view unit = "",
                 double rounding = 0.0) {
    return value >= low - rounding && value <= high + rounding ? *this : refuse(name, value, "", low, high, unit);
  }
  /// `low` < value ≤ `high`, to within `rounding` at `high`.
  RangeCheck& above(std::string_view name, double value, double low, double high = kMost, std::string_view unit = "",
                    double rounding = 0.0) {
    return value > low && value <= high + rounding ? *this : refuse(name, value, "more than ", low, high, unit);
  }
  /// The value is neither NaN nor infinite.
  RangeCheck& finite(std::string_view name, double value) {
    return value >= -kMost && value <= kMost ? *this : refuse(name, value, "", -kMost, kMost, "");
  }
  /// The value is one of an enumeration that ends with `last`.
  template <class Enum>
  RangeCheck& known(std::string_view name, Enum value, Enum last) {
    return in(name, static_cast<int>(value), 0, static_cast<int>(last));
  }
  /// `holds` is true; else `wrong` says what is wrong, and what to give.
  RangeCheck& that(bool holds, std::string_view wrong) {
    if (!holds && !wrong_) wrong_ = Error{std::string(wrong)};
    return *this;
  }
  /// The checks of a part of the value.
  RangeCheck& part(std::string_view name, const Status& good) {
    if (!good && !wrong_) wrong_ = Error{std::string(name) + ": " + good.error().message};
    return *this;
  }
  [[nodiscard]] Status result() const { return wrong_ ? Status(*wrong_) : Status(Done{}); }

 private:
  RangeCheck& refuse(std::string_view name, double value, std::string_view low_sign, double low, double high,
                     std::string_view unit);

  std::optional<Error> wrong_;
};

}  // namespace terrella
