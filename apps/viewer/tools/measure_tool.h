#pragma once

#include <string>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo/objects.h"

namespace terrella {

/// A sequence of places with the path between them, as text and as drawn objects. Pure values; thread: any
class MeasureTool {
 public:
  [[nodiscard]] const std::vector<Geodetic>& places() const { return places_; }
  void add(const Geodetic& place) { places_.push_back(place); }
  void take_back();  ///< removes the last place, if any
  void clear() { places_.clear(); }

  /// An instruction or the path's length; from three places on also the enclosed area.
  [[nodiscard]] std::string text(const Ellipsoid& ellipsoid) const;
  /// Objects for drawing: markers at the places, the path, and the length at the last place. From three places on, the
  /// closing edge (thinner) and the area are added. `scale` is the size of markers and lines, 1 at 96 dots per inch.
  [[nodiscard]] ObjectScene scene(const Ellipsoid& ellipsoid, float scale = 1.0F) const;

 private:
  std::vector<Geodetic> places_;
};

}  // namespace terrella
