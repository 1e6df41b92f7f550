#include "render/globe_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "render/frame_camera.h"
#include "render/gl/stencil_bits.h"
#include "surface/far_side_curtain.h"
#include "surface/relief.h"

namespace terrella {
namespace {

/// A pass that few frames need, made with the first of them. Fails only where the installation is broken.
template <class T, class... Given>
T& made(std::unique_ptr<T>& place, Given... given) {
  if (!place) {
    Result<std::unique_ptr<T>> pass = T::create(given...);
    if (!pass) throw std::runtime_error(pass.error().message);
    place = std::move(*pass);
  }
  return *place;
}

}  // namespace

Result<std::unique_ptr<GlobeRenderer>> GlobeRenderer::create(const RenderOptions& asked, const Ellipsoid& ellipsoid,
                                                             const SkyAssets* sky) {
  RenderOptions options = asked;
  options.night_lights = sky != nullptr && !sky->night_lights.values.empty();
  std::unique_ptr<GlobeRenderer> renderer(new GlobeRenderer(options, ellipsoid));
  const auto keep = [](auto& place, auto made) -> Status {
    if (!made) return made.error();
    place = std::move(*made);
    return Done{};
  };
  if (Status s = keep(renderer->limb_, LimbPass::create()); !s) return s.error();
  if (sky != nullptr) {
    if (Status s = keep(renderer->sky_, SkyPass::create(sky->body, sky->stars)); !s) return s.error();
  }
  if (options.night_lights) {
    Result<NightLights> lights = NightLights::create(sky->night_lights);
    if (!lights) return lights.error();
    renderer->night_lights_ = std::move(*lights);
  }
  renderer->frame_block_ = gl::make_buffer();
  glNamedBufferStorage(renderer->frame_block_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  return renderer;
}

Status GlobeRenderer::set_relief(bool on) {
  Result<std::unique_ptr<PatchPass>> made = PatchPass::create(options_, on);
  if (!made) return made.error();
  patches_ = std::move(*made);
  return Done{};
}

Status GlobeRenderer::set_objects(std::span<const CutScene> scenes) {
  if (!objects_) {
    Result<std::unique_ptr<ObjectPass>> made = ObjectPass::create(options_.depth);
    if (!made) return made.error();
    objects_ = std::move(*made);
    objects_->set_label_font(std::move(label_font_));
  }
  objects_->set_objects(make_batches(scenes, ellipsoid_));
  std::vector<MeshObject> meshes;
  std::vector<LabelObject> labels;
  for (const CutScene& from : scenes) {
    meshes.insert(meshes.end(), from.scene.meshes.begin(), from.scene.meshes.end());
    labels.insert(labels.end(), from.scene.labels.begin(), from.scene.labels.end());
  }
  if (Status set = objects_->set_meshes(meshes, ellipsoid_); !set) return set;
  return objects_->set_labels(labels, ellipsoid_);
}

FrameCounts GlobeRenderer::draw(const FrameInput& input, GLuint framebuffer) {
  FrameCounts counts;
  const bool selective = objects_ && input.surface.from_below == SurfaceFromBelow::selective;
  targets_.fit(input.size, input.sky || selective || input.stereo == Stereo::interlaced);
  upload_layers(input);
  const std::vector<EyePicture> pictures = pictures_of(input);
  begin_frame(input, counts);
  // Chosen for the first eye: both are to see the same.
  if (objects_) objects_->place_labels(pictures.front().view, label_sight({input, pictures.front(), counts}));
  for (const EyePicture& eye : pictures) draw_picture({input, eye, counts});
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glStencilMask(0xFF);
  glDisable(GL_SCISSOR_TEST);
  targets_.copy_to(framebuffer, input.corner_px);
  if (limb_comes_last({input, pictures.front(), counts})) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDisable(GL_STENCIL_TEST);
    draw_limb({input, pictures.front(), counts}, false);
  }
  return counts;
}

void GlobeRenderer::draw_picture(const Pass& pass) {
  upload_frame(pass);
  begin_picture(pass);
  if (pass.input.naive_translucency) {
    draw_naively(pass);
  } else if (under_ground(pass)) {
    draw_from_below(pass);
  } else {
    draw_from_above(pass);
  }
}

// Paper 2, 2.2, in its order.
void GlobeRenderer::draw_from_above(const Pass& pass) {
  const bool translucent = pass.input.surface.alpha < 1.0;
  if (translucent && objects_ && objects_->has(ObjectPart::underground)) {  // else there is nothing to hide
    draw_inner_sphere(pass);
    draw_far_side_curtain(pass);
  }
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  draw_surface(pass, translucent ? SurfaceFromBelow::translucent : SurfaceFromBelow::opaque);
  draw_sky(pass);
  if (!limb_comes_last(pass)) draw_limb(pass, true);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::all, 0);
}

// Paper 2, 2.9: what is over the ground lies behind the surface, what is under it before.
void GlobeRenderer::draw_from_below(const Pass& pass) {
  const SurfaceLook& surface = pass.input.surface;
  draw_inner_sphere(pass);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::others, 0);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::chosen, kThroughBit);
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  draw_surface(pass, surface.alpha < 1.0 ? surface.from_below : SurfaceFromBelow::opaque);
}

// An opaque globe's order with blending switched on, which paper 2 begins with (figures 2.23 to 2.26).
void GlobeRenderer::draw_naively(const Pass& pass) {
  draw_sky(pass);
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  blend(pass.input.surface);
  if (night_lights_) night_lights_->bind();
  draw_first(pass);
  glDisable(GL_BLEND);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::all, 0);
}

// Where nothing goes over it, the limb can be drawn as the picture is copied.
bool GlobeRenderer::limb_comes_last(const Pass& pass) const {
  if (pass.input.eyes || pass.input.corner_px != glm::ivec2(0)) return false;
  return !objects_ || !(under_ground(pass) || objects_->has(ObjectPart::above_ground));
}

// What the surface or the inner sphere will hide takes no room; imagery alone has no text.
LabelSight GlobeRenderer::label_sight(const Pass& pass) const {
  LabelSight sight;
  sight.shown = pass.input.lit;
  const SurfaceLook& surface = pass.input.surface;
  if (under_ground(pass)) {
    const SurfaceFromBelow look = surface.alpha < 1.0 ? surface.from_below : SurfaceFromBelow::opaque;
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

// Of the inner sphere where it is drawn, or one in an opaque surface: what it hides need not be begun.
double GlobeRenderer::hiding_radius_m(const Pass& pass) const {
  if (pass.input.naive_translucency) return 0.0;
  double radius_m = inner_radius_m(pass.input);
  if (!under_ground(pass) && pass.input.surface.alpha >= 1.0) {
    const double lowest_m = pass.input.relief != nullptr ? pass.input.relief->range_m().min_m : 0.0;
    radius_m = ellipsoid_.b_m() + std::min(lowest_m, 0.0);
  }
  return glm::length(pass.eye.view.eye.xyz_m) > radius_m ? radius_m : 0.0;
}

void GlobeRenderer::draw_objects(const Pass& pass, ObjectPart part, ObjectChoice choice, GLuint mark) {
  if (!objects_ || !objects_->has(part)) return;
  stencil(pass.eye, 0, mark);
  depth_test(DepthTest::nearer_or_equal);  // of objects at the same place the last is seen
  pass.counts.draw_calls += objects_->draw(part, frame_, pass.eye.view.viewport, choice, hiding_radius_m(pass));
  depth_test(DepthTest::nearer);
  glEnable(GL_CULL_FACE);
  stencil(pass.eye, 0, 0);
}

// Where no surface is; neither reads nor writes depth, so it moves no plane (paper 2, 2.3).
void GlobeRenderer::draw_sky(const Pass& pass) {
  if (!pass.input.sky || !sky_) return;
  stencil(pass.eye, kSurfaceBit, 0);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  pass.counts.draw_calls += sky_->draw(pass.eye.view, *pass.input.sky);
  glEnable(GL_CULL_FACE);
  depth_test(DepthTest::nearer);
  stencil(pass.eye, 0, 0);
}

void GlobeRenderer::draw_inner_sphere(const Pass& pass) {
  const double radius_m = inner_radius_m(pass.input);
  if (radius_m <= 0.0) return;
  if (glm::length(pass.eye.view.eye.xyz_m) <= radius_m) return;
  glCullFace(GL_BACK);
  pass.counts.draw_calls += made(inner_sphere_, options_.depth).draw(radius_m);
}

// What lies beyond the point of a line of sight that is nearest to the centre is the far side's. The inner sphere hides
// it where the line meets that sphere; where it passes by, between the sphere and the ground, the curtain does.
void GlobeRenderer::draw_far_side_curtain(const Pass& pass) {
  const Ellipsoid& e = ellipsoid_;
  const double radius_m = inner_radius_m(pass.input);
  if (radius_m <= 0.0) return;
  const double lowest_m = pass.input.relief != nullptr ? std::min(0.0, pass.input.relief->range_m().min_m) : 0.0;
  const std::vector<glm::vec3> curtain = far_side_curtain(pass.eye.view, e, radius_m, lowest_m);
  glDisable(GL_CULL_FACE);
  pass.counts.draw_calls += made(inner_sphere_, options_.depth).draw_curtain(curtain);
  glEnable(GL_CULL_FACE);
}

// Opaque in one pass; translucent in two, so that no part of the surface shows through another (paper 2, 2.2 and 2.11).
void GlobeRenderer::draw_surface(const Pass& pass, SurfaceFromBelow look) const {
  glCullFace(under_ground(pass) ? GL_FRONT : GL_BACK);
  for (const LayerFrame& layer : pass.further()) upload_frame(layer);
  if (look != SurfaceFromBelow::opaque) {
    color_mask(pass.eye, false);
    patches_->draw_depth(*pass.first().gpu, vertices_of(pass.first(), pass.first()), pass.counts);
    color_mask(pass.eye, true);
    glDepthFunc(GL_EQUAL);
    glDepthMask(GL_FALSE);
  }
  if (night_lights_) night_lights_->bind();
  if (look == SurfaceFromBelow::selective) {
    stencil(pass.eye, kThroughBit, 0);
    draw_layers(pass, SurfaceFromBelow::opaque);
    stencil(pass.eye, 0, 0, kThroughBit);
  } else {
    stencil(pass.eye, 0, kSurfaceBit);
  }
  draw_layers(pass, look);
  depth_test(DepthTest::nearer);
  stencil(pass.eye, 0, 0);
}

// The limb's ribbon is of the ellipsoid: where the ground rises from it by more than the ribbon is wide, it is none.
bool GlobeRenderer::mountains_on_limb(const Pass& pass) const {
  if (pass.input.relief == nullptr) return false;
  const double eye_m = glm::length(pass.eye.view.eye.xyz_m), a_m = ellipsoid_.a_m();
  const double limb_m = std::sqrt(std::max(1.0, (eye_m - a_m) * (eye_m + a_m)));
  return pass.input.relief->range_m().max_m * pass.eye.view.pixels_per_radian() > 0.5 * limb_m;
}

void GlobeRenderer::draw_limb(const Pass& pass, bool in_place) {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  const View& view = pass.eye.view;
  const LimbPicture picture{
      .texture = targets_.color(), .left_px = pass.eye.left_px, .rows_apart = pass.eye.interlaced ? 2 : 1};
  int& calls = pass.counts.draw_calls;
  if (mountains_on_limb(pass)) {
    const OutlinePass& outline = made(outline_);
    const float no_depth = options_.depth == DepthMode::reversed ? 0.0F : 1.0F;
    calls += in_place ? outline.draw_in_place(view.viewport, picture, targets_.depth(), no_depth, targets_.beside(),
                                              targets_.framebuffer())
                      : outline.draw(view.viewport, picture, targets_.depth(), no_depth);
  } else {
    calls += in_place ? limb_->draw_in_place(view, ellipsoid_, picture, targets_.beside(), targets_.framebuffer())
                      : limb_->draw(view, ellipsoid_, picture);
  }
  glEnable(GL_CULL_FACE);
  depth_test(DepthTest::nearer);
}

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

void GlobeRenderer::begin_frame(const FrameInput& input, FrameCounts& counts) {
  glBindFramebuffer(GL_FRAMEBUFFER, targets_.framebuffer());
  glViewport(0, 0, input.size.width_px, input.size.height_px);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(GL_CCW);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glStencilMask(0xFF);
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClearStencil(0);
  glClear(GL_COLOR_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  if (input.stereo == Stereo::interlaced) counts.draw_calls += made(interlace_).draw(input.size.height_px);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
}

void GlobeRenderer::begin_picture(const Pass& pass) const {
  const EyePicture& eye = pass.eye;
  glViewport(eye.left_px, 0, eye.view.viewport.width_px, eye.view.viewport.height_px);
  // A point's square may reach over the middle of a picture of two halves, and a clear knows no viewport.
  glScissor(eye.left_px, 0, eye.view.viewport.width_px, eye.view.viewport.height_px);
  glEnable(GL_SCISSOR_TEST);
  color_mask(eye, true);
  glStencilMask(kSurfaceBit | kThroughBit);
  glDepthMask(GL_TRUE);
  glClearDepth(options_.depth == DepthMode::reversed ? 0.0 : 1.0);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  depth_test(DepthTest::nearer);
  stencil(eye, 0, 0);
}

void GlobeRenderer::color_mask(const EyePicture& eye, bool on) const {
  glColorMask(on && eye.red, on && eye.green, on && eye.blue, on);
}

// Draws where bits are clear or set as they must be, in the eye's rows, and sets bits there.
void GlobeRenderer::stencil(const EyePicture& eye, GLuint must_be_clear, GLuint set, GLuint must_be_set) const {
  const GLuint rows = eye.interlaced ? kRightEyeBit : 0U;
  if (!targets_.has_stencil() || (rows | must_be_clear | set | must_be_set) == 0) {
    glDisable(GL_STENCIL_TEST);
    return;
  }
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, static_cast<GLint>(eye.row_bits | set | must_be_set), rows | must_be_clear | must_be_set);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glStencilMask(set);
}

void GlobeRenderer::depth_test(DepthTest test) const {
  const bool reversed = options_.depth == DepthMode::reversed;
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  if (test == DepthTest::nearer) {
    glDepthFunc(reversed ? GL_GREATER : GL_LESS);
  } else {
    glDepthFunc(reversed ? GL_GEQUAL : GL_LEQUAL);
  }
}

double GlobeRenderer::inner_radius_m(const FrameInput& input) const {
  const Ellipsoid& e = ellipsoid_;
  if (!input.surface.inner_sphere_below_m) return 0.0;
  return inner_sphere_radius_m(e.a_m(), e.b_m(), *input.surface.inner_sphere_below_m);
}

bool GlobeRenderer::under_ground(const Pass& pass) const {
  return ellipsoid_.to_geodetic(pass.eye.view.eye).height_m < pass.input.ground_m;
}

// A tenth of the way to the nearest thing that is drawn, less where the picture is very wide; the sky has no part in it
// (paper 2, 2.3).
double GlobeRenderer::near_m(const Pass& pass) const {
  const View& view = pass.eye.view;
  const Ecef& eye = view.eye;
  double free_m = std::abs(ellipsoid_.to_geodetic(eye).height_m - pass.input.ground_m);
  const double radius_m = inner_radius_m(pass.input);
  if (under_ground(pass) && radius_m > 0.0) {
    const double over_m = glm::length(eye.xyz_m) - radius_m;
    if (over_m > 0.0) free_m = std::min(free_m, over_m);
  }
  // That thing may lie in a corner of the picture: its depth is then less than its distance.
  const double tan_y = view.tan_half_fov_y, tan_x = tan_y * view.aspect() + std::abs(view.shear_x);
  const double cos_corner = 1.0 / std::sqrt(1.0 + tan_x * tan_x + tan_y * tan_y);
  return std::max(std::min(0.1, 0.9 * cos_corner) * free_m, 0.05);
}

void GlobeRenderer::upload_frame(const Pass& pass) {
  const View& view = pass.eye.view;
  const Ellipsoid& e = ellipsoid_;
  const double far_m = glm::length(view.eye.xyz_m) + 1.5 * e.a_m();
  FrameBlock& block = frame_;
  block = frame_of_camera(view, near_m(pass), far_m);
  block.sun_ecef = glm::vec4(glm::vec3(pass.input.sun), pass.input.lit ? 1.0F : 0.0F);
  describe_layer(pass.first(), block);
  glNamedBufferSubData(frame_block_.name(), 0, sizeof(block), &block);
}

}  // namespace terrella
