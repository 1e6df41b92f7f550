#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/panels/readout.h"
#include "geo/ellipsoid.h"
#include "geo/objects.h"

namespace terrella {

/// A sequence of places with the path between them, as text and as drawn objects. Pure values; thread: any
class MeasureTool {
 public:
  /// `encloses`: from three places on, the path encloses an area.
  explicit MeasureTool(bool encloses = true) : encloses_(encloses) {}

  [[nodiscard]] const std::vector<Geodetic>& places() const { return places_; }
  void add(const Geodetic& place) { places_.push_back(place); }
  void take_back();  ///< removes the last place, if any
  void clear() { places_.clear(); }

  /// An instruction or the path's length; from three places on also the enclosed area, if any. With `next`, a place
  /// under the cursor, also the length of the way to it and the new total, unless the cursor has not left the last
  /// place.
  [[nodiscard]] std::string text(const Ellipsoid& ellipsoid, const std::optional<Geodetic>& next = {},
                                 LengthUnits units = LengthUnits::metric) const;
  /// Objects for drawing: markers at the places, the path, and the length of each segment at its middle. From three
  /// places on, the total at the last place is added, and for an enclosed area the closing edge (thinner) and a fill.
  /// `scale` is the size of markers and lines, 1 at 96 dots per inch.
  [[nodiscard]] ObjectScene scene(const Ellipsoid& ellipsoid, float scale = 1.0F,
                                  LengthUnits units = LengthUnits::metric) const;

 private:
  bool encloses_;
  std::vector<Geodetic> places_;
};

}  // namespace terrella
