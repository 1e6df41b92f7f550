#include "view/render_modes.h"

#include "base/range_check.h"

namespace terrella {

Status check_surface(const SurfaceLook& surface) {
  return RangeCheck()
      .in("the surface's alpha", surface.alpha, 0.0, 1.0)
      .known("the blend", surface.blend, Blend::additive)
      .known("from_below", surface.from_below, SurfaceFromBelow::selective)
      .known("horizon_culling", surface.horizon_culling, HorizonCulling::off)
      .known("sharpness", surface.sharpness, Sharpness::bicubic)
      .in("the depth of the inner sphere", surface.inner_sphere_below_m.value_or(0.0), 0.0, 6378137.0, " m")
      .in("the place of the swipe's line", surface.swipe.value_or(0.0), 0.0, 1.0)
      .in("the red of the inner sphere", surface.inner_sphere_srgb.r, 0.0, 1.0)
      .in("the green of the inner sphere", surface.inner_sphere_srgb.g, 0.0, 1.0)
      .in("the blue of the inner sphere", surface.inner_sphere_srgb.b, 0.0, 1.0)
      .result();
}

Status check_stereo(const StereoLook& stereo) {
  return RangeCheck()
      .known("the mode", stereo.mode, Stereo::anaglyph)
      .in("the separation of the eyes", stereo.eye_separation_m.value_or(0.0), 0.0, 1e9, " m")
      .result();
}

}  // namespace terrella
