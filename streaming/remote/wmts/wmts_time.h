#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "base/time_steps.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// A <Dimension> of a layer.
struct WmtsDimension {
  std::string name{};
  std::string otherwise{};            ///< <Default>; empty: none
  std::vector<std::string> values{};  ///< single values, or START/END/PERIOD as in OGC 06-042
};

struct ChosenTime {
  std::string value{};
  bool newest = false;  ///< within a day of the last listed time: some tiles may not exist yet
  TimeSteps steps{};    ///< all that are listed; empty if one of them is no time
  std::string fault{};  ///< fault of a list that was not understood; else empty
};

/// Chooses the time to request: `given` if listed, else the default. Does not check that `given` is a step of a period.
/// The error lists the available times. thread: any
[[nodiscard]] Result<ChosenTime> choose_time(const WmtsDimension& dimension, const std::string& given);

/// Tells a tile set the chosen time and all others. thread: any
void set_times(ChosenTime chosen, RemoteTileSet& set);

}  // namespace terrella
