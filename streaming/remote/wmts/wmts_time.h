#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A <Dimension> of a layer.
struct WmtsDimension {
  std::string name{};
  std::string otherwise{};            ///< <Default>; empty: none
  std::vector<std::string> values{};  ///< single values, or START/END/PERIOD as OGC 06-042 writes them
};

struct ChosenTime {
  std::string value{};
  bool newest = false;  ///< within a day of the last that is listed: some of its tiles may be still to come
};

/// The time to ask for: `given`, if it is listed (periods are not counted out), else the default. The error says what
/// is listed. thread: any
[[nodiscard]] Result<ChosenTime> choose_time(const WmtsDimension& dimension, const std::string& given);

}  // namespace terrella
