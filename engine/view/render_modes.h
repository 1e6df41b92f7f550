#pragma once

#include <optional>

namespace terrella {

/// How patches are textured: shaders/README.md. `automatic` is the command line's `auto`.
enum class Texturing { vertex, paper, exact, automatic };

/// Depth format (engine/DESIGN.md, 6).
enum class DepthMode { reversed, logarithmic, standard };

/// How a translucent surface goes over what lies under it; paper 2, formulas (2.7) and (2.9).
enum class Blend {
  normal,    ///< A · surface + (1 - A) · below
  additive,  ///< A · surface + below: brighter, and it may saturate
};

/// What the surface does to an eye under it; paper 2, 2.9.
enum class SurfaceFromBelow {
  opaque,
  translucent,
  selective,  ///< opaque but before objects that ask to be seen through it
};

/// Whether patches that the planet itself hides are left out (paper 2, 2.8).
enum class HorizonCulling {
  automatic,  ///< what cannot be seen: from above behind the horizon, from below behind the inner sphere, if there is
              ///< one
  on,         ///< from below, the other half of the planet too: for one object nearby
  off,        ///< all that is in the picture's frame
};

/// How the surface looks; can change from frame to frame.
struct SurfaceLook {
  double alpha = 1.0;  ///< A, [0, 1]; 1: opaque, drawn in one pass
  Blend blend = Blend::normal;
  /// A sphere of the background's colour so far under the equator hides what lies under the far side of a translucent
  /// globe (paper 2, 2.1); none: nothing is hidden. In metres of Earth: on other bodies the same part of their radius.
  std::optional<double> inner_sphere_below_m = 1.0e6;
  SurfaceFromBelow from_below = SurfaceFromBelow::opaque;
  HorizonCulling horizon_culling = HorizonCulling::automatic;
  bool operator==(const SurfaceLook&) const = default;
};

enum class Stereo {
  off,
  side_by_side,  ///< the left eye's picture in the left half
  interlaced,    ///< the left eye's picture in the even rows, counted from the top
  anaglyph,      ///< the left eye's red, the right eye's green and blue
};

/// How the two eyes look; can change from frame to frame.
struct StereoLook {
  Stereo mode = Stereo::off;
  std::optional<double> eye_separation_m{};  ///< none: a thirtieth of the distance to what is in the picture's middle
  bool operator==(const StereoLook&) const = default;
};

}  // namespace terrella
