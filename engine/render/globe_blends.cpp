#include <algorithm>
#include <utility>

#include "render/globe_renderer.h"

// Layers that blend with the picture of the layers below (LayerBlend). Their programs read a copy of that picture, take
// light and air from its colours, blend, and add light and air again. This holds for any number of layers below, of any
// grids, and a layer that does not blend keeps its programs and its stack.
namespace terrella {
namespace {

constexpr GLuint kCopyUnit = 11;  // patch_blend.glsl, patch_behind.frag

}  // namespace

bool GlobeRenderer::has_blends(const Pass& pass) {
  return std::ranges::any_of(pass.upper(), [](const LayerFrame& layer) { return layer.blend != LayerBlend::normal; });
}

// Copies the means of samples. False if the driver has no memory.
bool GlobeRenderer::copy_picture(const Pass& pass, Copy what) const {
  const FrameTargets::Beside copy = targets_->beside(static_cast<std::size_t>(what));
  if (copy.texture == 0) {
    pass.counts.no_memory = true;
    return false;
  }
  apply({});  // a scissor would cut the copy
  targets_->copy_to(copy.framebuffer, {0, 0});
  return true;
}

void GlobeRenderer::bind_copy(Copy what) const {
  glBindTextureUnit(kCopyUnit, targets_->beside(static_cast<std::size_t>(what)).texture);
  glBindSampler(kCopyUnit, 0);
}

void GlobeRenderer::draw_on_ground(const Pass& pass, const LayerFrame& layer, const DrawState& state) const {
  if (layer.patches->empty()) return;
  if (layer.blend != LayerBlend::normal) {
    if (!copy_picture(pass, Copy::below)) return;
    bind_copy(Copy::below);
  }
  draw_upper(pass, layer, state);
}

// Colours below are needed as an opaque surface has them. The picture behind the surface then comes back with its
// share.
void GlobeRenderer::draw_blends_translucent(const Pass& pass, DrawState state) const {
  if (!copy_picture(pass, Copy::behind)) return;
  state.blend.reset();
  draw_base(pass, state);
  state.blend = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE};
  for (const LayerFrame& layer : pass.upper()) draw_on_ground(pass, layer, state);
  bind_copy(Copy::behind);
  state.blend = surface_blend(pass.input.surface);
  std::swap(state.blend->from_rgb, state.blend->to_rgb);
  draw_whole(pass, PatchPass::Whole::behind, state);
}

}  // namespace terrella
