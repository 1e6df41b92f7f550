#include "render/globe_renderer.h"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "render/frame_camera.h"
#include "render/gl/stencil_bits.h"
#include "surface/limb.h"

// The image layers of the surface. The base layer is drawn with depth; upper layers are blended over equal depth.
// Paper 2: "Interactive visualization of 3D data on a virtual globe in stereoscopic systems", abstract of a
// dissertation, chapter 2.2.
namespace terrella {
namespace {

// In a lit picture, longer pixels than this beside the limb are integrated whole, so that ice there shows no dashes.
// Air before the limb takes contrast from the ground: 8 then has an error up to a twelfth more than 5 and costs a tenth
// of a frame less, and 12 has up to a fifth more. A picture of the imagery alone keeps to the plain footprint, which
// measurements compare.
constexpr double kFootprintInAir_texels = 8.0, kFootprintWithoutAir_texels = 5.0;
// A raised limb reaches the middle of each pixel that it covers in part.
constexpr double kRaised_px = 0.75;
// Three taps reach over this many texels.
constexpr double kShortPixel_texels = 2.0;

double lit_footprint_texels(const FrameInput& input) {
  return input.sky ? kFootprintInAir_texels : kFootprintWithoutAir_texels;
}

}  // namespace

void GlobeRenderer::set_relief(bool on) {
  if (!patches_) make_patches(options_, on);
  patches_->set_relief(on);
  relief_ = on;
  slopes_.reset();
}

void GlobeRenderer::make_patches(RenderOptions options, bool relief) {
  options.light.relief = relief && options.light.relief;
  patches_ = PatchPass::create(options, relief);
}

Status GlobeRenderer::set_night_lights(const GreyPicture& map) {
  RenderOptions options = options_;
  options.night_lights = !map.values.empty();
  std::optional<NightLights> lights;
  if (options.night_lights) {
    Result<NightLights> made = NightLights::create(map);
    if (!made) return made.error();
    lights = std::move(*made);
  }
  if (patches_) make_patches(options, relief_);
  options_ = options;
  night_lights_ = std::move(lights);
  return Done{};
}

PatchBuffers& GlobeRenderer::vertices_of(const LayerFrame& layer, const LayerFrame& base) {
  return *layer.vertices ? **layer.vertices : **base.vertices;
}

PatchScene GlobeRenderer::scene_of(const Pass& pass) const {
  PatchScene scene{.air = air_of(pass), .light = light_of(pass.input), .paper_band = pass.input.paper_band};
  if (limb_look(pass, scene.air) == LimbLook::whole && limb_->fit(pass.input.view, ellipsoid_)) {
    scene.limb = LimbRing(pass.input.view, ellipsoid_);
  }
  if (!pass.input.lit) return scene;
  scene.sun = pass.input.sun;
  scene.plain_footprint_texels = lit_footprint_texels(pass.input);
  return scene;
}

// An opaque surface takes one pass. A translucent surface takes two, so that no part of the surface shows through
// another (paper 2, sections 2.2 and 2.11).
void GlobeRenderer::draw_surface(const Pass& pass) const {
  const SurfaceFromBelow look = surface_look(pass);
  DrawState state = picture_state(pass.eye);
  if (under_ground(pass)) state.cull = GL_FRONT;
  for (const LayerFrame& layer : pass.upper()) upload_frame(pass, layer);
  if (look != SurfaceFromBelow::opaque) {
    DrawState depth_only = state;
    depth_only.color = {false, false, false, false};
    draw_whole(pass, PatchPass::Whole::depth, depth_only);
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
  if (look != SurfaceFromBelow::opaque && air_ != nullptr) draw_air_before_glass(pass, state);
}

// Blending took a part of the air's light with the surface's. It comes back: the air lies before the surface, and the
// limb's pixels have all of it.
void GlobeRenderer::draw_air_before_glass(const Pass& pass, DrawState state) const {
  state.blend = {.from_rgb = GL_CONSTANT_ALPHA,
                 .to_rgb = GL_ONE,
                 .from_alpha = GL_ZERO,
                 .to_alpha = GL_ONE,
                 .constant_alpha = static_cast<float>(1.0 - pass.input.surface.alpha)};
  draw_whole(pass, PatchPass::Whole::air, state);
}

void GlobeRenderer::draw_whole(const Pass& pass, PatchPass::Whole what, const DrawState& state) const {
  const LayerFrame& base = pass.base();
  patches_->draw_whole(what, *base.gpu, vertices_of(base, base), state, pass.counts);
}

void GlobeRenderer::draw_layers(const Pass& pass, SurfaceFromBelow look, DrawState state) const {
  const bool translucent = look != SurfaceFromBelow::opaque;
  if (translucent && !pass.upper().empty()) return draw_layers_translucent(pass, state);
  if (translucent) state.blend = surface_blend(pass.input.surface);
  draw_base(pass, state);
  draw_stacks(pass, true, state);
  state.depth = kSameDepth;
  state.blend = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE};
  draw_stacks(pass, false, state);
  for (const LayerFrame& layer : pass.upper()) {
    if (is_over_ground(pass, layer)) {
      draw_at_height(pass, layer, -layer.height_m / ellipsoid_.a_m(), state);  // its shadow
    } else {
      draw_on_ground(pass, layer, state);
    }
  }
}

// An unlit layer lies on the ground: its pixels are compared with others.
bool GlobeRenderer::is_over_ground(const Pass& pass, const LayerFrame& layer) const {
  return layer.height_m > 0.0 && pass.input.lit && ellipsoid_.to_geodetic(pass.eye.view.eye).height_m > layer.height_m;
}

// `height` is FrameBlock::surface_look.x.
void GlobeRenderer::draw_at_height(const Pass& pass, const LayerFrame& layer, double height,
                                   const DrawState& state) const {
  if (layer.patches->empty()) return;
  const auto value = static_cast<float>(height);
  glNamedBufferSubData(layer.gpu->frame_block.name(), offsetof(FrameBlock, surface_look), sizeof(float), &value);
  draw_upper(pass, layer, state, height > 0.0 ? PatchPass::Limb::flat : PatchPass::Limb::raised);
}

// After sky and limb, which lie behind such a layer beyond the limb. The layers write no depth.
void GlobeRenderer::draw_layers_over_ground(const Pass& pass) const {
  if (surface_look(pass) == SurfaceFromBelow::translucent) return;
  DrawState state = picture_state(pass.eye);
  state.depth = depth(DepthTest::nearer_or_equal);
  state.depth->write = false;
  state.blend = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE};
  if (night_lights_) night_lights_->bind();
  for (const LayerFrame& layer : pass.upper()) {
    if (is_over_ground(pass, layer)) draw_at_height(pass, layer, layer.height_m, state);
  }
}

// First the background under the surface is dimmed. Then the layers add their parts from the top down. Meanwhile the
// alpha of the picture holds the part that is left for lower layers. At the end the picture is opaque again.
void GlobeRenderer::draw_layers_translucent(const Pass& pass, DrawState state) const {
  if (has_blends(pass)) return draw_blends_translucent(pass, state);
  state.blend = surface_blend(pass.input.surface);
  state.blend->from_rgb = GL_ZERO;
  state.blend->from_alpha = GL_CONSTANT_ALPHA;
  state.blend->to_alpha = GL_ZERO;
  draw_whole(pass, PatchPass::Whole::black, state);
  state.blend = {GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA};
  for (auto layer = pass.upper().rbegin(); layer != pass.upper().rend(); ++layer) draw_upper(pass, *layer, state);
  draw_base(pass, state);
  state.blend.reset();
  state.color = {false, false, false, true};
  draw_whole(pass, PatchPass::Whole::black, state);
}

void GlobeRenderer::draw_stacks(const Pass& pass, bool first_pass, const DrawState& state) const {
  const LayerFrame& base = pass.base();
  if (light_of(pass.input).relief) slopes_->bind(*base.gpu);
  patches_->draw_stacks(stacks_, first_pass, stack_layers_, *base.gpu, vertices_of(base, base),
                        {pass.input.ground, pass.input.ground_gpu}, state, pass.counts);
}

void GlobeRenderer::draw_base(const Pass& pass, const DrawState& state) const {
  const LayerFrame& base = pass.base();
  if (light_of(pass.input).relief) slopes_->bind(*base.gpu);
  patches_->draw(*base.gpu, vertices_of(base, base), *base.tiles, LayerRole::base, state, pass.counts);
}

void GlobeRenderer::draw_upper(const Pass& pass, const LayerFrame& layer, const DrawState& state,
                               PatchPass::Limb limb) const {
  if (layer.patches->empty()) return;
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, layer.gpu->frame_block.name());
  if (light_of(pass.input).relief) slopes_->bind(*layer.gpu);
  patches_->draw(*layer.gpu, vertices_of(layer, pass.base()), *layer.tiles, pass.role_of(layer), state, pass.counts,
                 limb);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
}

// Paper 2's formulas (2.7) and (2.9).
BlendState GlobeRenderer::surface_blend(const SurfaceLook& look) {
  return {.from_rgb = GL_CONSTANT_ALPHA,
          .to_rgb = static_cast<GLenum>(look.blend == Blend::normal ? GL_ONE_MINUS_CONSTANT_ALPHA : GL_ONE),
          .from_alpha = GL_ZERO,
          .to_alpha = GL_ONE,
          .constant_alpha = static_cast<float>(look.alpha)};
}

// Sets the uniforms of a limb whose pixels show their own ground.
void GlobeRenderer::describe_limb(const Pass& pass, FrameBlock& block) const {
  const std::optional<LimbSquare> limb = limb_square(pass.eye.view, ellipsoid_);
  if (!limb) return;
  const double pixel = glm::length(limb->slope);
  block.limb = glm::vec4(0.5 * kRaised_px * pixel * ellipsoid_.a_m(), kLimb_px * pixel, 0.0, 0.0);
  block.limb_at_px = glm::vec4(limb->at_px.x + pass.eye.left_px, limb->at_px.y, limb->slope);
  block.limb_bend = glm::vec4(limb->bend, limb->there);
}

glm::vec4 GlobeRenderer::texels_of(const LayerFrame& layer) const {
  const SlotLayout& layout = layer.tiles->layout();
  const bool centric = layer.tree->grid().latitude == LatitudeKind::centric;
  const double layer_px = layout.layer_px();
  return {layout.tile_px / layer_px, layer_px, layout.slot_px() / layer_px, centric ? ellipsoid_.one_minus_e2() : 1.0};
}

// Sets the uniforms that depend on a layer.
void GlobeRenderer::describe_layer(const Pass& pass, const LayerFrame& layer, FrameBlock& block) const {
  block.texels = texels_of(layer);
  block.paper.z = layer.tree->grid().projection == Projection::equal_area ? 1.0F : 0.0F;
  block.paper.w = static_cast<float>(layer.opacity);
  block.layer_look = look_of(pass, layer);
  block.layer_tone = tone_of(layer);
  block.limb.z = static_cast<float>(layer.blend);
}

// Values of FrameBlock::layer_look.
glm::vec4 GlobeRenderer::look_of(const Pass& pass, const LayerFrame& layer) {
  const float side = layer.daylight == Daylight::both ? 0.0F : layer.daylight == Daylight::day ? 1.0F : -1.0F;
  float line_px = 0.0F;
  if (layer.swipe != SwipeSide::both && pass.input.surface.swipe) {
    // A quarter of a pixel keeps the line off the middles of pixels, and off 0.
    line_px = static_cast<float>(swipe_px(*pass.input.surface.swipe, pass.eye.view.viewport.width_px) + 0.25);
  }
  return {side, layer.alpha == AlphaFrom::brightness ? 1.0F : 0.0F,
          layer.swipe == SwipeSide::behind ? -line_px : line_px, layer.unlit ? 1.0F : 0.0F};
}

// Values of FrameBlock::layer_tone.
glm::vec4 GlobeRenderer::tone_of(const LayerFrame& layer) {
  return {layer.tone.brightness, layer.tone.contrast, 1.0 / layer.tone.gamma, layer.tone == ImageTone{} ? 0.0 : 1.0};
}

PatchLight GlobeRenderer::light_of(const FrameInput& input) {
  const Sharpness sharpness = input.surface.sharpness;
  return {.relief = input.relief != nullptr && input.lit,
          .bicubic = sharpness == Sharpness::bicubic || (sharpness == Sharpness::automatic && input.lit),
          .glint = input.lit && input.timed && input.sky && input.earth && input.surface.glint};
}

void GlobeRenderer::upload_frame(const Pass& pass) {
  const View& view = pass.eye.view;
  const Ellipsoid& e = ellipsoid_;
  const double far_m = glm::length(view.eye.xyz_m) + 1.5 * e.a_m();
  FrameBlock& block = frame_;
  block = frame_of_camera(view, near_m(pass), far_m);
  block.sun_ecef = glm::vec4(glm::vec3(pass.input.sun), pass.input.lit ? 1.0F : 0.0F);
  block.paper = glm::vec4(pass.input.paper_a, pass.input.paper_band, 0.0, 0.0);
  if (air_ != nullptr) {
    block.horizon_from_ecef = glm::mat4(glm::mat3(air_->horizon_from_ecef() * e.a_m()));
    const double r = air_->eye_radius(), horizon_m = e.a_m() * std::sqrt((r - 1.0) * (r + 1.0));
    block.horizon_from_ecef[3] = glm::vec4(e.one_minus_e2(), 1.0 / horizon_m, r * e.a_m(), (r - 1.0) * e.a_m());
  }
  const double focal_px = view.pixels_per_radian(), left_px = pass.eye.left_px;
  block.axis_px = glm::vec4(left_px + 0.5 * view.viewport.width_px - view.shear_x * focal_px,
                            0.5 * view.viewport.height_px, 1.0 / focal_px, left_px);
  if (limb_look(pass, air_) == LimbLook::whole) describe_limb(pass, block);
  if (light_of(pass.input).relief) {
    block.relief = glm::vec4(pass.input.relief->exaggeration(), pass.input.surface.hillshade ? 1.0 : 0.0,
                             slopes_->slot_share(), 0.0);
  }
  block.relief.w = static_cast<float>(pass.input.pixel_scale);
  constexpr float kNightAtATime = 0.02F, kNight = 0.25F;  // without a time the Sun is only a lamp
  block.surface_look =
      glm::vec4(0.0F, pass.input.timed ? kNightAtATime : kNight,
                pass.input.lit ? lit_footprint_texels(pass.input) : kShortPixel_texels, pass.input.timed ? 1.0F : 0.0F);
  describe_layer(pass, pass.base(), block);
  glNamedBufferSubData(frame_block_.name(), 0, sizeof(block), &block);
}

void GlobeRenderer::upload_frame(const Pass& pass, const LayerFrame& layer) const {
  if (layer.patches->empty()) return;
  FrameBlock block = frame_;
  describe_layer(pass, layer, block);
  gl::Buffer& buffer = layer.gpu->frame_block;
  if (!buffer) {
    buffer = gl::make_buffer();
    glNamedBufferStorage(buffer.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  glNamedBufferSubData(buffer.name(), 0, sizeof(block), &block);
}

}  // namespace terrella
