#include "render/globe_renderer.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "render/gl/stencil_bits.h"
#include "surface/far_side_curtain.h"
#include "surface/relief.h"

// The order of the passes of a frame.
// Paper 2: "Interactive visualization of 3D data on a virtual globe in stereoscopic systems", abstract of a
// dissertation, chapter 2.2.
namespace terrella {
namespace {

/// Makes a pass unless it exists. Fails only if the installation or the driver is broken.
template <class T, class... Given>
Status make_once(std::unique_ptr<T>& place, const Given&... given) {
  if (place) return Done{};
  Result<std::unique_ptr<T>> made = T::create(given...);
  if (!made) return made.error();
  place = std::move(*made);
  return Done{};
}

}  // namespace

Result<std::unique_ptr<GlobeRenderer>> GlobeRenderer::create(const RenderOptions& options, const Ellipsoid& ellipsoid,
                                                             const SkyAssets* sky) {
  std::unique_ptr<GlobeRenderer> renderer(new GlobeRenderer(options, ellipsoid));
  renderer->limb_ = std::make_unique<LimbPass>();
  if (sky != nullptr) {
    renderer->sky_ = std::make_unique<SkyPass>(sky->body, sky->stars);
    if (Status s = renderer->set_night_lights(sky->night_lights); !s) return s.error();
  }
  renderer->frame_block_ = gl::make_buffer();
  glNamedBufferStorage(renderer->frame_block_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  return renderer;
}

Status GlobeRenderer::set_objects(std::vector<DrawnLayer> layers) {
  if (Status s = make_once(objects_, options_.depth); !s) return s;
  if (!label_font_.empty()) objects_->set_label_font(std::exchange(label_font_, {}));
  objects_->set_layers(std::move(layers));
  return objects_->prepare();
}

// Programs depend on the samples of the targets, so these come first.
Status GlobeRenderer::prepare(const FrameInput& input, PictureMemory& memory, GLuint framebuffer) {
  if (Status fits = fit_targets(input, memory, framebuffer); !fits) return fits;
  if (objects_) {
    if (Status prepared = objects_->prepare(); !prepared) return prepared;
    objects_->upload();  // the choice of further passes depends on the uploaded objects
  }
  if (sky_) sky_->keep_air_in(memory.air);
  FrameCounts counts;
  for (const EyePicture& eye : pictures_of(input)) {
    if (Status prepared = prepare({input, eye, counts}); !prepared) return prepared;
  }
  return Done{};
}

// Makes all programs that a frame needs before it draws, so that a frame is drawn as a whole or not at all.
Status GlobeRenderer::prepare(const Pass& pass) {
  if (pass.input.sky && sky_ && (pass.input.naive_translucency || !under_ground(pass))) {
    if (Status s = sky_->prepare(pass.eye.view, sky_of(pass)); !s) return s;
  }
  if (Status s = prepare_layers(pass); !s) return s;
  if (surface_look(pass) != SurfaceFromBelow::opaque) {
    if (Status s = patches_->prepare_whole(PatchPass::Whole::depth); !s) return s;
    if (Status s = air_of(pass) != nullptr ? patches_->prepare_whole(PatchPass::Whole::air) : Done{}; !s) return s;
  }
  if (has_inner_sphere(pass)) {
    if (Status s = make_once(inner_sphere_, options_.depth); !s) return s;
  }
  const bool samples = targets_->samples() > 0;
  if (!mountains_on_limb(pass)) {
    if (Status s = limb_->prepare(limb_look(pass, air_of(pass)), samples); !s) return s;
  } else if (!samples) {
    if (Status s = make_once(outline_); !s) return s;
  }
  if (pass.input.ground != nullptr && !ground_in_stacks_) {
    if (Status s = patches_->prepare_ground(*pass.input.ground, *pass.base().patches); !s) return s;
  }
  return pass.input.stereo == Stereo::interlaced ? make_once(interlace_) : Done{};
}

Result<FrameCounts> GlobeRenderer::draw(const FrameInput& input, PictureMemory& memory, GLuint framebuffer) {
  if (Status prepared = prepare(input, memory, framebuffer); !prepared) return prepared.error();
  FrameCounts counts;
  counts.objects_left_out = objects_ && !objects_->has_memory();
  const std::vector<EyePicture> pictures = pictures_of(input);
  if (Status uploaded = upload_layers(input); !uploaded) return uploaded.error();
  begin_frame(input, counts);
  memory.frame = input.frame;
  targets_->set_frame(input.frame);
  // Places for labels are chosen for the first eye, so that both eyes see the same labels.
  if (objects_) {
    objects_->place_labels(pictures.front().view, label_sight({input, pictures.front(), counts}), memory.labels);
  }
  for (const EyePicture& eye : pictures) draw_picture({input, eye, counts});
  hand_over(input, framebuffer);
  if (limb_comes_last({input, pictures.front(), counts})) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    draw_limb({input, pictures.front(), counts}, false);
  }
  if (counts.no_memory) return Error{"Globe::render: the driver has no memory for the limb; draw a smaller picture"};
  return counts;
}

// The air before ground and limb. An eye under the ground sees none.
const AirTextures* GlobeRenderer::air_of(const Pass& pass) const {
  if (!pass.input.sky || !sky_ || under_ground(pass) || pass.input.naive_translucency) return nullptr;
  return sky_->fit_air(pass.eye.view, sky_of(pass));
}

void GlobeRenderer::draw_picture(const Pass& pass) {
  const PatchScene scene = scene_of(pass);
  air_ = scene.air;
  patches_->set_scene(scene);  // prepare() has built the programs
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

// The order of passes of paper 2, section 2.2.
void GlobeRenderer::draw_from_above(const Pass& pass) {
  if (has_inner_sphere(pass)) {
    draw_inner_sphere(pass);
    draw_far_side_curtain(pass);
  }
  // An underground object may stand out over the limb. Under an opaque surface it is drawn after sky and limb; under a
  // translucent surface it is marked, so that no air is painted over it.
  const bool opaque = surface_look(pass) == SurfaceFromBelow::opaque;
  if (!opaque) {
    draw_objects(pass, ObjectPart::underground, ObjectChoice::all, kSurfaceBit);
    draw_callers(pass, DrawStage::below_ground);
  }
  draw_surface(pass);
  draw_ground(pass, over_surface(pass));
  draw_callers(pass, DrawStage::ground);
  draw_sky(pass);
  if (!limb_comes_last(pass)) draw_limb(pass, true);
  draw_layers_over_ground(pass);
  if (opaque) draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::all, 0);
  draw_callers(pass, DrawStage::all);
}

// Paper 2, section 2.9: objects above the ground lie behind the surface, objects under the ground lie in front of it.
void GlobeRenderer::draw_from_below(const Pass& pass) {
  if (has_inner_sphere(pass)) draw_inner_sphere(pass);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::others, 0);
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::chosen, kThroughBit);
  if (surface_look(pass) != SurfaceFromBelow::opaque) {  // behind the surface, at its depth
    DrawState behind = picture_state(pass.eye);
    behind.cull = GL_FRONT;
    behind.depth->write = false;
    draw_ground(pass, behind);
  }
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  if (surface_look(pass) != SurfaceFromBelow::opaque) draw_callers(pass, DrawStage::below_ground);
  draw_surface(pass);
  draw_callers(pass, DrawStage::ground);
  draw_callers(pass, DrawStage::all);
}

// Draws in the order of an opaque globe with blending switched on, as in paper 2's figures 2.23 to 2.26.
void GlobeRenderer::draw_naively(const Pass& pass) {
  draw_sky(pass);
  draw_objects(pass, ObjectPart::underground, ObjectChoice::all, 0);
  if (night_lights_) night_lights_->bind();
  DrawState state = picture_state(pass.eye);
  state.blend = surface_blend(pass.input.surface);
  draw_base(pass, state);
  draw_ground(pass, over_surface(pass));
  draw_objects(pass, ObjectPart::above_ground, ObjectChoice::all, 0);
}

void GlobeRenderer::draw_objects(const Pass& pass, ObjectPart part, ObjectChoice choice, GLuint mark) {
  if (!objects_ || !objects_->has(part)) return;
  DrawState state = picture_state(pass.eye);
  state.depth = depth(DepthTest::nearer_or_equal);  // the last of several objects at one place is visible
  state.stencil = stencil(pass.eye, {.set = mark});
  if (air_ != nullptr) air_->bind_ground();
  pass.counts.draw_calls += objects_->draw(part, frame_, pass.eye.view.viewport, state, choice, hiding_radius_m(pass));
}

DrawState GlobeRenderer::over_surface(const Pass& pass) const {
  DrawState state = picture_state(pass.eye);
  state.depth = kSameDepth;
  return state;
}

// Before anything else is drawn on the ground. `state` has the depth test.
void GlobeRenderer::draw_ground(const Pass& pass, DrawState state) const {
  if (pass.input.ground == nullptr || ground_in_stacks_) return;
  const LayerFrame& base = pass.base();
  state.blend = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE};
  patches_->draw_ground({pass.input.ground, pass.input.ground_gpu}, *base.gpu, vertices_of(base, base), state,
                        pass.counts);
}

// The sky is drawn where there is no surface. It writes no depth, so it does not affect the near and the far plane
// (paper 2, section 2.3). Depth tells where an opaque surface is, so stencil is not needed. Under a translucent surface
// objects are marked.
void GlobeRenderer::draw_sky(const Pass& pass) {
  if (!pass.input.sky || !sky_) return;
  DrawState state = picture_state(pass.eye);
  if (pass.input.surface.alpha < 1.0) {
    state.depth.reset();
    state.stencil = stencil(pass.eye, {.clear = kSurfaceBit});
  } else {
    state.depth = {.test = depth(DepthTest::nearer_or_equal).test, .write = false};
    state.flat_depth = no_depth();
  }
  pass.counts.draw_calls += sky_->draw(pass.eye.view, sky_of(pass), state);
}

void GlobeRenderer::draw_inner_sphere(const Pass& pass) {
  const double radius_m = inner_radius_m(pass.input);
  if (glm::length(pass.eye.view.eye.xyz_m) <= radius_m) return;
  pass.counts.draw_calls +=
      inner_sphere_->draw(radius_m, pass.input.surface.inner_sphere_srgb, picture_state(pass.eye));
}

// A line of sight reaches the far side of the globe beyond its point that is nearest to the centre. The inner sphere
// hides the far side from lines that meet the sphere. The curtain hides it from lines that pass between the sphere and
// the ground.
void GlobeRenderer::draw_far_side_curtain(const Pass& pass) {
  const Ellipsoid& e = ellipsoid_;
  const double radius_m = inner_radius_m(pass.input);
  const double lowest_m = pass.input.relief != nullptr ? std::min(0.0, pass.input.relief->range_m().min_m) : 0.0;
  const std::vector<glm::vec3> curtain = far_side_curtain(pass.eye.view, e, radius_m, lowest_m);
  const glm::vec3& color_srgb = pass.input.surface.inner_sphere_srgb;
  pass.counts.draw_calls += inner_sphere_->draw_curtain(curtain, color_srgb, picture_state(pass.eye));
}

void GlobeRenderer::draw_limb(const Pass& pass, bool in_place) {
  const View& view = pass.eye.view;
  const bool mountains = mountains_on_limb(pass);
  if (mountains && targets_->samples() > 0) return;  // samples cover their outline by parts
  if (!mountains && !limb_->fit(view, ellipsoid_)) return;
  const DrawState state = in_place ? picture_state(pass.eye) : DrawState{};
  const auto draw = [&](GLuint texture, GLuint depth, int rows_apart) {
    const LimbPicture picture{.texture = texture,
                              .left_px = pass.eye.left_px,
                              .rows_apart = rows_apart,
                              .from_samples = targets_->samples() > 0};
    mountains ? outline_->draw(view.viewport, picture, {depth, static_cast<float>(no_depth())}, state)
              : limb_->draw(view, picture, limb_look(pass, air_), air_, state);
    ++pass.counts.draw_calls;
  };
  const int rows_apart = pass.eye.interlaced ? 2 : 1;
  if (!in_place) return draw(targets_->color(), targets_->depth(), rows_apart);
  // A pass must not read the texture that it writes, so the limb is first drawn beside the picture.
  const FrameTargets::Beside beside = targets_->beside();
  if (beside.texture == 0) {
    pass.counts.no_memory = true;
    return;
  }
  apply({});
  targets_->resolve_color(beside);  // the ribbon covers samples of pixels whose centres it misses
  glBindFramebuffer(GL_FRAMEBUFFER, beside.framebuffer);
  apply(state);
  if (mountains) glClearBufferfv(GL_COLOR, 0, std::array<float, 4>{}.data());
  draw(targets_->color(), targets_->depth(), rows_apart);
  glBindFramebuffer(GL_FRAMEBUFFER, targets_->framebuffer());
  draw(beside.texture, 0, 0);
}

void GlobeRenderer::begin_frame(const FrameInput& input, FrameCounts& counts) {
  glBindFramebuffer(GL_FRAMEBUFFER, targets_->framebuffer());
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
  // The square of a point may cross the middle of a side-by-side picture, and a clear ignores the viewport.
  glScissor(eye.left_px, 0, eye.view.viewport.width_px, eye.view.viewport.height_px);
  DrawState state = picture_state(eye);
  state.stencil = {.write_mask = kSurfaceBit | kThroughBit};  // keeps the bits of the interlaced rows
  apply(state);
  glClearDepth(no_depth());
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
  if (!targets_->has_stencil() || (read | marks.set) == 0) return std::nullopt;
  return StencilState{.reference = eye.row_bits | marks.set | marks.needed, .read_mask = read, .write_mask = marks.set};
}

DepthState GlobeRenderer::depth(DepthTest test) const {
  const bool reversed = options_.depth == DepthMode::reversed;
  if (test == DepthTest::nearer) return {.test = static_cast<GLenum>(reversed ? GL_GREATER : GL_LESS)};
  return {.test = static_cast<GLenum>(reversed ? GL_GEQUAL : GL_LEQUAL)};
}

}  // namespace terrella
