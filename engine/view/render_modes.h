#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "base/result.h"

// Paper 2: "Interactive visualization of 3D data on a virtual globe in stereoscopic systems", abstract of a
// dissertation, chapter 2.2.

namespace terrella {

// Plain values. thread: any

/// The texturing method of patches: shaders/README.md. `automatic` is the command line's `auto`.
enum class Texturing { vertex, paper, exact, automatic };

/// Depth format (engine/DESIGN.md, 6).
enum class DepthMode { reversed, logarithmic, standard };

/// Blending of a translucent surface with the picture under it; paper 2, formulas (2.7) and (2.9).
enum class Blend {
  normal,    ///< A · surface + (1 - A) · below
  additive,  ///< A · surface + below: brighter, may saturate
};

/// Appearance of the surface to an eye under it; paper 2, 2.9.
enum class SurfaceFromBelow {
  opaque,
  translucent,
  selective,  ///< opaque except in front of objects that ask to be seen through it
};

/// Culling of patches that the planet itself hides (paper 2, 2.8).
enum class HorizonCulling {
  /// Culls invisible patches: from above those behind the horizon, from below those behind the inner sphere, if there
  /// is an inner sphere.
  automatic,
  on,   ///< from below, culls the other half of the planet too; useful for one object nearby
  off,  ///< draws all patches in the view frustum
};

/// Filter of imagery whose texels are larger than pixels.
enum class Sharpness {
  automatic,  ///< bicubic; in an unlit picture, which is compared with others, bilinear
  bilinear,   ///< one look-up, with edges between texels
  bicubic,    ///< Catmull-Rom's filter: a tenth less error than bilinear, and no edges
};

/// The look of the surface. It can change from frame to frame.
struct SurfaceLook {
  double alpha = 1.0;  ///< A, [0, 1]; 1: opaque, drawn in one pass
  Blend blend = Blend::normal;
  /// Depth of the inner sphere under the equator. The inner sphere has the background's colour and hides the objects
  /// under the far side of a translucent globe (paper 2, 2.1). None: nothing is hidden. In metres of Earth; other
  /// bodies use the same fraction of their radius. [0, 6378137].
  std::optional<double> inner_sphere_below_m = 1.0e6;
  SurfaceFromBelow from_below = SurfaceFromBelow::opaque;
  HorizonCulling horizon_culling = HorizonCulling::automatic;
  /// Colour of the inner sphere, sRGB, [0, 1]. Black is paper 2's, the background's. Another colour is shaded softly,
  /// so that the sphere looks round, and shows through a translucent surface also if nothing lies below.
  glm::vec3 inner_sphere_srgb{0.0F};
  /// Shades relief by light from the north-west at 45°, as maps do, instead of by the Sun. No effect without heights.
  bool hillshade = false;
  Sharpness sharpness = Sharpness::automatic;
  /// The Sun's glint on the Earth's seas, where the base layer is as blue as water. Only with a sky and a time.
  bool glint = true;
  /// Place of the line between layers that are compared (ImageLook::swipe), as a fraction of the picture's width from
  /// the left, [0, 1]. In stereo each eye's picture has one. None: every layer shows everywhere.
  std::optional<double> swipe{};
  bool operator==(const SurfaceLook&) const = default;
};

enum class Stereo {
  off,
  side_by_side,  ///< the left half shows the left eye's picture
  interlaced,    ///< the even rows, counted from the top, show the left eye's picture
  anaglyph,      ///< red shows the left eye's picture, green and blue show the right eye's
};

/// The look of stereo. It can change from frame to frame.
struct StereoLook {
  Stereo mode = Stereo::off;
  /// [0, 1e9]; none: 1/30 of the distance to the scene at the picture's middle.
  std::optional<double> eye_separation_m{};
  bool operator==(const StereoLook&) const = default;
};

/// Fails if a value is out of its range, and names the value. thread: any
[[nodiscard]] Status check_surface(const SurfaceLook& surface);
[[nodiscard]] Status check_stereo(const StereoLook& stereo);

}  // namespace terrella
