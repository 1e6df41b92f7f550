#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "geo/camera.h"
#include "geo/objects.h"

namespace terrella {

/// A visible piece of a meridian or parallel, in pixels of the picture; may reach past its edges.
struct GraticuleLine {
  std::vector<glm::dvec2> points_px;  ///< at least 2; chords are under half a pixel off the curve
  bool principal = false;             ///< equator, prime meridian, antimeridian
};

/// A line's name: UTF-8, as "30° N". It stands in the picture so that the part `anchor` of its box (0 left or top, 1
/// right or bottom) is at `at_px`.
struct GraticuleLabel {
  std::string text;
  glm::dvec2 at_px{0.0};
  glm::dvec2 anchor{0.0};
};

struct Graticule {
  double parallels_deg = 0.0;  ///< distance of parallels
  double meridians_deg = 0.0;  ///< distance of meridians, wider towards the poles
  std::vector<GraticuleLine> lines;
  std::vector<GraticuleLabel> labels;
};

/// How large labels will be, so that none covers another, and what they keep free.
struct LabelSize {
  double character_px = 8.0;
  double line_px = 16.0;
  double foot_px = 0.0;  ///< along the picture's lower edge, where something else is written
};

/// The lines of equal latitude and longitude in a picture: 30° to 0.001° apart, by zoom; the part of each that the
/// horizon does not hide. Parallels are named at the left edge or the limb, meridians at the lower edge or, where they
/// do not reach it, along the parallel next to the picture's centre. At most some 120 lines. thread: any
[[nodiscard]] Graticule make_graticule(const View& view, const Ellipsoid& ellipsoid, LabelSize label = {});

/// How a graticule that is a layer looks.
struct GraticuleLook {
  double spacing_deg = 15.0;  ///< of parallels and meridians: [1, 90], taken to the nearest divisor of 90
  double height_m = 0.0;      ///< over the ellipsoid: relief hides what lies under it
  float width_px = 1.0F;
  ObjectColor color{255, 255, 255, 110};
  bool labels = true;  ///< parallels along the prime meridian, meridians along the equator; others' labels go first
};

/// The whole planet's lines as objects: a layer for Globe::add_objects() that no view changes. Meridians are exact,
/// parallels pieces of geodesics within 0.0003° (30 m on Earth) of them; of the meridians those of whole 90° alone
/// reach the poles, the others end at the last parallel. thread: any
[[nodiscard]] ObjectScene graticule_objects(const GraticuleLook& look = {});

}  // namespace terrella
