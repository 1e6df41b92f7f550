#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/gl/stencil_bits.h"
#include "render/globe_renderer.h"
#include "surface/far_side_curtain.h"

// The eyes of a picture, and the sight of one eye: the objects, labels and limb that the surface or the inner sphere
// hides, and the near plane. Paper 2: "Interactive visualization of 3D data on a virtual globe in stereoscopic
// systems", abstract of a dissertation, chapter 2.2.
namespace terrella {

std::vector<GlobeRenderer::EyePicture> GlobeRenderer::pictures_of(const FrameInput& input) {
  if (!input.eyes) return {{.view = input.view}};
  EyePicture left{.view = input.eyes->left}, right{.view = input.eyes->right};
  switch (input.stereo) {
    case Stereo::side_by_side:
      right.left_px = input.eyes->left.viewport.width_px;
      break;
    case Stereo::interlaced:
      left.interlaced = right.interlaced = true;
      right.row_bits = kRightEyeBit;
      break;
    case Stereo::anaglyph:
      left.green = left.blue = right.red = false;
      break;
    case Stereo::off:
      break;
  }
  return {left, right};
}

bool GlobeRenderer::under_ground(const Pass& pass) const {
  return ellipsoid_.to_geodetic(pass.eye.view.eye).height_m < pass.input.ground_m;
}

SurfaceFromBelow GlobeRenderer::surface_look(const Pass& pass) const {
  if (pass.input.surface.alpha >= 1.0) return SurfaceFromBelow::opaque;
  return under_ground(pass) ? pass.input.surface.from_below : SurfaceFromBelow::translucent;
}

double GlobeRenderer::inner_radius_m(const FrameInput& input) const {
  const Ellipsoid& e = ellipsoid_;
  if (!input.surface.inner_sphere_below_m) return 0.0;
  return inner_sphere_radius_m(e.a_m(), e.b_m(), *input.surface.inner_sphere_below_m);
}

// The inner sphere hides the far side. An eye under the ground always looks at the far side; an eye above sees it
// through a translucent surface.
bool GlobeRenderer::has_inner_sphere(const Pass& pass) const {
  if (inner_radius_m(pass.input) <= 0.0) return false;
  if (under_ground(pass)) return true;
  const bool coloured = pass.input.surface.inner_sphere_srgb != glm::vec3(0.0F);
  return pass.input.surface.alpha < 1.0 && (coloured || (objects_ && objects_->has(ObjectPart::underground)));
}

// Radius of a sphere that hides objects, so that they need not be drawn: the inner sphere, or the largest sphere under
// an opaque surface. 0 if there is none.
double GlobeRenderer::hiding_radius_m(const Pass& pass) const {
  if (pass.input.naive_translucency) return 0.0;
  double radius_m = inner_radius_m(pass.input);
  if (!under_ground(pass) && pass.input.surface.alpha >= 1.0) {
    const double lowest_m = pass.input.relief != nullptr ? pass.input.relief->range_m().min_m : 0.0;
    radius_m = ellipsoid_.b_m() + std::min(lowest_m, 0.0);
  }
  return glm::length(pass.eye.view.eye.xyz_m) > radius_m ? radius_m : 0.0;
}

// Labels hidden by the surface or the inner sphere take no room. An unlit picture has no labels.
LabelSight GlobeRenderer::label_sight(const Pass& pass) const {
  LabelSight sight;
  sight.limb = &ellipsoid_;
  sight.shown = pass.input.lit;
  sight.pixel_scale = static_cast<float>(pass.input.pixel_scale);
  const SurfaceLook& surface = pass.input.surface;
  if (under_ground(pass)) {
    const SurfaceFromBelow look = surface_look(pass);
    sight.above_ground = look == SurfaceFromBelow::translucent;
    sight.chosen_above_ground = look != SurfaceFromBelow::opaque;
  }
  if (!under_ground(pass) && surface.alpha >= 1.0) {
    constexpr double kNotTheGroundItself = 1.0 - 1e-5;
    const Ellipsoid& e = ellipsoid_;
    const double lowest_m = pass.input.relief != nullptr ? std::min(pass.input.relief->range_m().min_m, 0.0) : 0.0;
    sight.hiding_half_axes_m = kNotTheGroundItself * (glm::dvec3(e.a_m(), e.a_m(), e.b_m()) + lowest_m);
  } else {
    sight.hiding_half_axes_m = glm::dvec3(hiding_radius_m(pass));
  }
  return sight;
}

// The ribbon that smooths the limb follows the ellipsoid. It fails if the ground is above or below the ellipsoid by
// more than half a pixel at the limb.
bool GlobeRenderer::mountains_on_limb(const Pass& pass) const {
  if (pass.input.relief == nullptr) return false;
  const double eye_m = glm::length(pass.eye.view.eye.xyz_m), a_m = ellipsoid_.a_m();
  const double limb_m = std::sqrt(std::max(1.0, (eye_m - a_m) * (eye_m + a_m)));
  const GroundRange range = pass.input.relief->range_m();
  return std::max(range.max_m, -range.min_m) * pass.eye.view.pixels_per_radian() > 0.5 * limb_m;
}

// Between mountains and over basins the sky shows below the ellipsoid's limb.
SkyInput GlobeRenderer::sky_of(const Pass& pass) const {
  SkyInput sky = *pass.input.sky;
  if (mountains_on_limb(pass)) sky.below_m = std::max(1.0, -pass.input.relief->range_m().min_m);
  return sky;
}

// If nothing covers the limb, the limb is drawn after the picture is copied, which saves a copy.
bool GlobeRenderer::limb_comes_last(const Pass& pass) const {
  if (targets_->samples() > 0) return false;  // the caller's framebuffer gets whole samples
  if (pass.input.eyes || pass.input.corner_px != glm::ivec2(0) || *pass.input.on_draw) return false;
  const auto is_over = [&](const LayerFrame& layer) { return is_over_ground(pass, layer); };
  if (std::ranges::any_of(pass.upper(), is_over)) return false;
  if (!objects_) return true;
  return !(under_ground(pass) || objects_->has(ObjectPart::above_ground) || objects_->has(ObjectPart::underground));
}

// From within the air, the air beside the limb is many pixels thick. Samples cover the limb's pixels by parts.
LimbLook GlobeRenderer::limb_look(const Pass& pass, const AirTextures* air) const {
  if (!pass.input.lit) return LimbLook::imagery;
  const bool has_limb = !mountains_on_limb(pass) && !under_ground(pass) && !pass.input.naive_translucency;
  if (air == nullptr && has_limb && targets_->samples() == 0) return LimbLook::whole;
  return air != nullptr && air->sky().outside ? LimbLook::in_air : LimbLook::lit;
}

// Distance of the near plane: a tenth of the way to the nearest thing that is drawn, less if the picture is very wide.
// The sky does not count (paper 2, section 2.3).
double GlobeRenderer::near_m(const Pass& pass) const {
  const View& view = pass.eye.view;
  const Ecef& eye = view.eye;
  double free_m = std::abs(ellipsoid_.to_geodetic(eye).height_m - pass.input.ground_m);
  const double radius_m = inner_radius_m(pass.input);
  if (under_ground(pass) && radius_m > 0.0) {
    const double over_m = glm::length(eye.xyz_m) - radius_m;
    if (over_m > 0.0) free_m = std::min(free_m, over_m);
  }
  // The nearest thing may lie in a corner of the picture, and its depth is then less than its distance.
  const double tan_y = view.tan_half_fov_y, tan_x = tan_y * view.aspect() + std::abs(view.shear_x);
  const double cos_corner = 1.0 / std::sqrt(1.0 + tan_x * tan_x + tan_y * tan_y);
  return std::max(std::min(0.1, 0.9 * cos_corner) * free_m, 0.05);
}

}  // namespace terrella
