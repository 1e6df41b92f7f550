#pragma once

#include <optional>
#include <string>
#include <vector>

#include "globe/globe.h"

// thread: the globe's, for all of this header
namespace terrella {

/// Shows an image layer at a time of ISO 8601, which parse_utc() reads. Fails as Globe::set_layer_time() does.
[[nodiscard]] Status go_to_time(Globe& globe, LayerId layer, const std::string& time);
/// The time that an image layer shows, as its service writes it; none if it has no time.
[[nodiscard]] Result<std::optional<std::string>> shown_time(const Globe& globe, LayerId layer);
/// All times of an image layer, earliest first; none if it has none. Fails for more than 100,000.
[[nodiscard]] Result<std::vector<std::string>> listed_times(const Globe& globe, LayerId layer);

}  // namespace terrella
