#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/open_scene.h"
#include "base/utc_time.h"

namespace terrella {

/// Sentences about layers that follow a time and do not show the date of that time. thread: that of the globe
[[nodiscard]] std::vector<std::string> missing_dates(const OpenedScene& scene, const std::optional<UtcTime>& time);

}  // namespace terrella
