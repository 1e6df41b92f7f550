#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "geo/camera.h"
#include "geo/objects.h"

namespace terrella {

/// A visible piece of a meridian or parallel, in pixels of the picture. It may extend past the picture's edges.
struct GraticuleLine {
  std::vector<glm::dvec2> points_px;  ///< at least 2; chords are within half a pixel of the curve
  bool principal = false;             ///< true for the equator, prime meridian and antimeridian
  float strength = 1.0F;              ///< (0, 1]: opacity. Lines fade out with distance, where they would run together
};

/// The name of a line: UTF-8, as "30° N". Its box is placed so that the point `anchor` of the box (0 left or top, 1
/// right or bottom) is at `at_px`.
struct GraticuleLabel {
  std::string text;
  glm::dvec2 at_px{0.0};
  glm::dvec2 anchor{0.0};
};

struct Graticule {
  double parallels_deg = 0.0;  ///< distance between parallels at the picture's centre
  double meridians_deg = 0.0;  ///< distance between meridians there, wider towards the poles
  std::vector<GraticuleLine> lines;
  std::vector<GraticuleLabel> labels;
};

/// Size of the labels, so that they do not cover each other, and the margin that they keep free.
struct LabelSize {
  double character_px = 8.0;
  double line_px = 16.0;
  double foot_px = 0.0;  ///< margin at the picture's lower edge, for other text
};

/// Returns the visible lines of equal latitude and longitude in a picture, 90° to 0.001° apart. The spacing follows the
/// distance of the ground: in a tilted view the foreground has finer lines, and only every fifth or so goes on towards
/// the horizon. Lines behind the horizon are left out. Parallels are labelled at the left edge or at the limb.
/// Meridians are labelled at the lower edge, or, if they do not reach it, along the parallel next to the picture's
/// centre. Labels do not cover each other. thread: any
[[nodiscard]] Graticule make_graticule(const View& view, const Ellipsoid& ellipsoid, LabelSize label = {});

/// The look of a graticule that is an object layer.
struct GraticuleLook {
  /// Spacing of parallels and meridians: [1, 90], changed to the nearest divisor of 90.
  double spacing_deg = 15.0;
  double height_m = 0.0;  ///< height over the ellipsoid: relief hides lines under it
  float width_px = 1.0F;
  ObjectColor color{255, 255, 255, 110};
  /// Labels parallels along the prime meridian and meridians along the equator; labels of other layers have priority.
  bool labels = true;
};

/// Returns the lines of the whole planet as objects for Globe::add_objects(). They do not depend on the view. Meridians
/// are exact. Parallels are pieces of geodesics within 0.0003° (30 m on Earth). Only the meridians at multiples of 90°
/// reach the poles; the others end at the last parallel. thread: any
[[nodiscard]] ObjectScene graticule_objects(const GraticuleLook& look = {});

}  // namespace terrella
