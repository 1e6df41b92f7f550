#pragma once

#include <optional>

#include "base/utc_time.h"
#include "geo/objects.h"

// thread: any, for all of this header
namespace terrella {

/// Least and greatest zoom level. At zoom z a picture has 512 · 2^z pixels for the length of the equator, as in
/// MapLibre.
inline constexpr double kLeastZoom = 0.0, kMostZoom = 24.0;

/// The zoom levels and instants at which a feature is shown.
struct ShownWhen {
  ObjectId id = ObjectId::none;
  double from_zoom = kLeastZoom;            ///< shown from this zoom level on, [kLeastZoom, kMostZoom]
  double before_zoom = kMostZoom;           ///< and below this one; kMostZoom: at all levels above `from_zoom`
  std::optional<UtcTime> from{}, before{};  ///< shown from one instant until another; none: no bound
};

/// True for a feature that is shown at all levels and instants.
[[nodiscard]] inline bool is_always_shown(const ShownWhen& when) {
  return when.from_zoom <= kLeastZoom && when.before_zoom >= kMostZoom && !when.from && !when.before;
}

}  // namespace terrella
