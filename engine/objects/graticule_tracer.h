#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "geo/camera.h"

namespace terrella {

/// A visible piece of a curve. Neighbouring pieces of one curve share a point if only their strength differs.
struct TracedPiece {
  std::vector<glm::dvec2> points_px;
  float strength = 1.0F;  ///< (0, 1]
};

/// The spacing of a curve's lines, and the distance between them at which they fade.
struct TracedSpacing {
  double spacing_deg = 1.0;  ///< to the next line of the same level
  bool narrows = false;      ///< true for meridians: the distance shrinks with the cosine of the latitude
  double faint_px = 0.0;     ///< lines nearer together than this are left out
  double full_px = 0.0;      ///< lines farther apart than this have their full strength; > faint_px
};

/// Turns curves on the ellipsoid into the visible pieces of their pictures. `view` and `ellipsoid` must live as long.
/// thread: any for every call
class GraticuleTracer {
 public:
  using Curve = std::function<Geodetic(double)>;

  GraticuleTracer(const View& view, const Ellipsoid& ellipsoid);
  /// Follows `curve` over [from, to] with steps of at most `step`.
  [[nodiscard]] std::vector<TracedPiece> trace(const Curve& curve, const TracedSpacing& spacing, double from, double to,
                                               double step) const;
  /// Pixels of a degree of a great circle that is seen from above at a distance in metres.
  [[nodiscard]] double pixels_per_degree(double distance_m) const;
  /// Arc of ground from the place under the eye to the farthest point where a degree has `least_px` at least; at most
  /// to the horizon.
  [[nodiscard]] double reach_deg(double least_px) const;

 private:
  struct Spot {
    glm::dvec2 px;
    double strength;
  };
  [[nodiscard]] std::optional<Spot> spot(const Geodetic& place, const TracedSpacing& spacing) const;
  [[nodiscard]] Spot edge(const Curve& curve, const TracedSpacing& spacing, double seen, double unseen) const;

  const View& view_;
  const Ellipsoid& ellipsoid_;
};

}  // namespace terrella
