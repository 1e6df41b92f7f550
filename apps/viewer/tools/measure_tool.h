#pragma once

#include <string>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo/objects.h"

namespace terrella {

/// Places set one after the other, what lies between them, and how that is drawn and said. Pure values; thread: any
class MeasureTool {
 public:
  [[nodiscard]] const std::vector<Geodetic>& places() const { return places_; }
  void add(const Geodetic& place) { places_.push_back(place); }
  void take_back();  ///< the last place; nothing if there is none
  void clear() { places_.clear(); }

  /// What to do, or how long the way is, and from three places on how large the area is that they enclose.
  [[nodiscard]] std::string text(const Ellipsoid& ellipsoid) const;
  /// The places as markers, the way between them, from three places on the way back, thinner, and the area; the length
  /// at the last place. `scale`: of markers and lines, 1 at 96 dots per inch.
  [[nodiscard]] ObjectScene scene(const Ellipsoid& ellipsoid, float scale = 1.0F) const;

 private:
  std::vector<Geodetic> places_;
};

}  // namespace terrella
