#include "render/globe_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/frame_camera.h"
#include "render/gl/stencil_bits.h"
#include "surface/far_side_curtain.h"
#include "surface/relief.h"

namespace terrella {
namespace {

/// Makes a pass if it is not there yet. Fails only if the installation or the driver is broken.
template <class T, class... Given>
Status make_once(std::unique_ptr<T>& place, const Given&... given) {
  if (place) return Done{};
  Result<std::unique_ptr<T>> made = T::create(given...);
  if (!made) return made.error();
  place = std::move(*made);
  return Done{};
}

}  // namespace

Result<std::unique_ptr<GlobeRenderer>> GlobeRenderer::create(const RenderOptions& asked, const Ellipsoid& ellipsoid,
                                                             const SkyAssets* sky) {
  RenderOptions options = asked;
  options.night_lights = sky != nullptr && !sky->night_lights.values.empty();
  std::unique_ptr<GlobeRenderer> renderer(new GlobeRenderer(options, ellipsoid));
  if (Status s = make_once(renderer->limb_); !s) return s.error();
  if (sky != nullptr) {
    if (Status s = make_once(renderer->sky_, sky->body, sky->stars); !s) return s.error();
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

// Draws have nothing to make, so that a frame is drawn as a whole or not at all.
Status GlobeRenderer::prepare(const Pass& pass) {
  if (const auto further = pass.further(); !further.empty()) {
    const bool special = std::ranges::any_of(further, &LayerFrame::is_special);
    if (Status s = patches_->prepare_further(special); !s) return s;
  }
  if (surface_look(pass) != SurfaceFromBelow::opaque) {
    if (Status s = patches_->prepare_depth(); !s) return s;
  }
  if (has_inner_sphere(pass)) {
    if (Status s = make_once(inner_sphere_, options_.depth); !s) return s;
  }
  if (mountains_on_limb(pass)) {
    if (Status s = make_once(outline_); !s) return s;
  }
  return pass.input.stereo == Stereo::interlaced ? make_once(interlace_) : Done{};
}

Result<FrameCounts> GlobeRenderer::draw(const FrameInput& input, GLuint framebuffer) {
  FrameCounts counts;
  const std::vector<EyePicture> pictures = pictures_of(input);
  for (const EyePicture& eye : pictures) {
    if (Status prepared = prepare({input, eye, counts}); !prepared) return prepared.error();
  }
  const bool selective = objects_ && input.surface.from_below == SurfaceFromBelow::selective;
  targets_.fit(input.size, input.sky || selective || input.stereo == Stereo::interlaced);
  upload_layers(input);
  begin_frame(input, counts);
  // Chosen for the first eye: both are to see the same.
  if (objects_) objects_->place_labels(pictures.front().view, label_sight({input, pictures.front(), counts}));
  for (const EyePicture& eye : pictures) draw_picture({input, eye, counts});
  apply({});  // the scissor would cut the copy
  targets_.copy_to(framebuffer, input.corner_px);
  if (limb_comes_last({input, pictures.front(), counts})) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
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
  if (has_inner_sphere(pass)) {
    draw_inner_sphere(pass);
    draw_far_side_curtain(pass);
  }
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  draw_surface(pass);
  draw_sky(pass);
  if (!limb_comes_last(pass)) draw_limb(pass, true);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::all, 0);
}

// Paper 2, 2.9: what is over the ground lies behind the surface, what is under it before.
void GlobeRenderer::draw_from_below(const Pass& pass) {
  if (has_inner_sphere(pass)) draw_inner_sphere(pass);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::others, 0);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::chosen, kThroughBit);
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  draw_surface(pass);
}

// An opaque globe's order with blending switched on, which paper 2 begins with (figures 2.23 to 2.26).
void GlobeRenderer::draw_naively(const Pass& pass) {
  draw_sky(pass);
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  if (night_lights_) night_lights_->bind();
  DrawState state = picture_state(pass.eye);
  state.blend = surface_blend(pass.input.surface);
  draw_first(pass, state);
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
  DrawState state = picture_state(pass.eye);
  state.depth = depth(DepthTest::nearer_or_equal);  // the last of several objects at the same place is seen
  state.stencil = stencil(pass.eye, {.set = mark});
  pass.counts.draw_calls += objects_->draw(part, frame_, pass.eye.view.viewport, state, choice, hiding_radius_m(pass));
}

// Where no surface is; neither reads nor writes depth, so it moves no plane (paper 2, 2.3).
void GlobeRenderer::draw_sky(const Pass& pass) {
  if (!pass.input.sky || !sky_) return;
  DrawState state = picture_state(pass.eye);
  state.stencil = stencil(pass.eye, {.clear = kSurfaceBit});
  pass.counts.draw_calls += sky_->draw(pass.eye.view, *pass.input.sky, state);
}

// The sphere hides the far side, which an eye under the ground always sees, and an eye above through the surface.
bool GlobeRenderer::has_inner_sphere(const Pass& pass) const {
  if (inner_radius_m(pass.input) <= 0.0) return false;
  if (under_ground(pass)) return true;
  return pass.input.surface.alpha < 1.0 && objects_ && objects_->has(ObjectPart::underground);
}

void GlobeRenderer::draw_inner_sphere(const Pass& pass) {
  const double radius_m = inner_radius_m(pass.input);
  if (glm::length(pass.eye.view.eye.xyz_m) <= radius_m) return;
  pass.counts.draw_calls += inner_sphere_->draw(radius_m, picture_state(pass.eye));
}

// What lies beyond the point of a line of sight that is nearest to the centre is the far side's. The inner sphere hides
// it where the line meets that sphere; where it passes by, between the sphere and the ground, the curtain does.
void GlobeRenderer::draw_far_side_curtain(const Pass& pass) {
  const Ellipsoid& e = ellipsoid_;
  const double radius_m = inner_radius_m(pass.input);
  const double lowest_m = pass.input.relief != nullptr ? std::min(0.0, pass.input.relief->range_m().min_m) : 0.0;
  const std::vector<glm::vec3> curtain = far_side_curtain(pass.eye.view, e, radius_m, lowest_m);
  pass.counts.draw_calls += inner_sphere_->draw_curtain(curtain, picture_state(pass.eye));
}

SurfaceFromBelow GlobeRenderer::surface_look(const Pass& pass) const {
  if (pass.input.surface.alpha >= 1.0) return SurfaceFromBelow::opaque;
  return under_ground(pass) ? pass.input.surface.from_below : SurfaceFromBelow::translucent;
}

// Opaque in one pass; translucent in two, so that no part of the surface shows through another (paper 2, 2.2 and 2.11).
void GlobeRenderer::draw_surface(const Pass& pass) const {
  const SurfaceFromBelow look = surface_look(pass);
  DrawState state = picture_state(pass.eye);
  if (under_ground(pass)) state.cull = GL_FRONT;
  for (const LayerFrame& layer : pass.further()) upload_frame(layer);
  if (look != SurfaceFromBelow::opaque) {
    DrawState depth_only = state;
    depth_only.color = {false, false, false, false};
    patches_->draw_depth(*pass.first().gpu, vertices_of(pass.first(), pass.first()), depth_only, pass.counts);
    state.depth = kSameDepth;
  }
  if (night_lights_) night_lights_->bind();
  if (look == SurfaceFromBelow::selective) {
    state.stencil = stencil(pass.eye, {.clear = kThroughBit});
    draw_layers(pass, SurfaceFromBelow::opaque, state);
    state.stencil = stencil(pass.eye, {.needed = kThroughBit});
  } else {
    state.stencil = stencil(pass.eye, {.set = kSurfaceBit});
  }
  draw_layers(pass, look, state);
}

// The limb's ribbon is of the ellipsoid: where the ground rises from it by more than the ribbon is wide, it is none.
bool GlobeRenderer::mountains_on_limb(const Pass& pass) const {
  if (pass.input.relief == nullptr) return false;
  const double eye_m = glm::length(pass.eye.view.eye.xyz_m), a_m = ellipsoid_.a_m();
  const double limb_m = std::sqrt(std::max(1.0, (eye_m - a_m) * (eye_m + a_m)));
  return pass.input.relief->range_m().max_m * pass.eye.view.pixels_per_radian() > 0.5 * limb_m;
}

void GlobeRenderer::draw_limb(const Pass& pass, bool in_place) {
  const DrawState state = in_place ? picture_state(pass.eye) : DrawState{};
  const View& view = pass.eye.view;
  const LimbPicture picture{
      .texture = targets_.color(), .left_px = pass.eye.left_px, .rows_apart = pass.eye.interlaced ? 2 : 1};
  int& calls = pass.counts.draw_calls;
  if (mountains_on_limb(pass)) {
    const float no_depth = options_.depth == DepthMode::reversed ? 0.0F : 1.0F;
    const OutlineDepth depth{targets_.depth(), no_depth};
    calls += in_place ? outline_->draw_in_place(view.viewport, picture, depth, state, targets_.beside(),
                                                targets_.framebuffer())
                      : outline_->draw(view.viewport, picture, depth, state);
  } else {
    calls += in_place
                 ? limb_->draw_in_place(view, ellipsoid_, picture, state, targets_.beside(), targets_.framebuffer())
                 : limb_->draw(view, ellipsoid_, picture, state);
  }
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
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(GL_CCW);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  apply({});
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClearStencil(0);
  glClear(GL_COLOR_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  if (input.stereo == Stereo::interlaced) counts.draw_calls += interlace_->draw(input.size.height_px);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
}

void GlobeRenderer::begin_picture(const Pass& pass) const {
  const EyePicture& eye = pass.eye;
  glViewport(eye.left_px, 0, eye.view.viewport.width_px, eye.view.viewport.height_px);
  // A point's square may reach over the middle of a picture of two halves, and a clear knows no viewport.
  glScissor(eye.left_px, 0, eye.view.viewport.width_px, eye.view.viewport.height_px);
  DrawState state = picture_state(eye);
  state.stencil = {.write_mask = kSurfaceBit | kThroughBit};  // keeps the interlaced rows
  apply(state);
  glClearDepth(options_.depth == DepthMode::reversed ? 0.0 : 1.0);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

DrawState GlobeRenderer::picture_state(const EyePicture& eye) const {
  return {.depth = depth(DepthTest::nearer),
          .stencil = stencil(eye, {}),
          .color = {eye.red, eye.green, eye.blue, true},
          .cull = GL_BACK,
          .scissor = true};
}

std::optional<StencilState> GlobeRenderer::stencil(const EyePicture& eye, const Marks& marks) const {
  const GLuint rows = eye.interlaced ? kRightEyeBit : 0U;
  const GLuint read = rows | marks.clear | marks.needed;
  if (!targets_.has_stencil() || (read | marks.set) == 0) return std::nullopt;
  return StencilState{.reference = eye.row_bits | marks.set | marks.needed, .read_mask = read, .write_mask = marks.set};
}

DepthState GlobeRenderer::depth(DepthTest test) const {
  const bool reversed = options_.depth == DepthMode::reversed;
  if (test == DepthTest::nearer) return {.test = static_cast<GLenum>(reversed ? GL_GREATER : GL_LESS)};
  return {.test = static_cast<GLenum>(reversed ? GL_GEQUAL : GL_LEQUAL)};
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
