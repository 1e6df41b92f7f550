#include "base/range_check.h"

#include <fmt/format.h>

namespace terrella {

RangeCheck& RangeCheck::refuse(std::string_view name, double value, std::string_view low_sign, double low, double high,
                               std::string_view unit) {
  if (wrong_) return *this;
  std::string range = "a finite number";
  if (low > -kMost) range = fmt::format("{}{}{}", low_sign, low, unit);
  if (low > -kMost && high < kMost) range += fmt::format(" to {}{}", high, unit);
  if (low > -kMost && high == kMost && low_sign.empty()) range += " or more";
  wrong_ = Error{fmt::format("{} is {}{}; give {}", name, value, unit, range)};
  return *this;
}

}  // namespace terrella
