#include "render/globe_renderer.h"

// The surface's image layers: the first as it is, those over it blended where their depth is equal.
namespace terrella {

PatchBuffers& GlobeRenderer::vertices_of(const LayerFrame& layer, const LayerFrame& first) {
  return layer.gpu->vertices ? *layer.gpu->vertices : *first.gpu->vertices;
}

// Further layers whose rows count the same latitude take the vertices of the first.
void GlobeRenderer::upload_layers(const FrameInput& input) const {
  const LayerFrame& first = input.layers.front();
  const TileGrid& rows = first.tree->grid();
  for (const LayerFrame& layer : input.layers) {
    const TileGrid& grid = layer.tree->grid();
    const bool shares = &layer != &first && grid.projection == rows.projection && grid.latitude == rows.latitude;
    std::unique_ptr<PatchBuffers>& own = layer.gpu->vertices;
    if (shares) {
      own.reset();
    } else if (!own) {
      own = std::make_unique<PatchBuffers>(*layer.tree, input.relief != nullptr);
    }
    patches_->upload(*layer.gpu, vertices_of(layer, first), *layer.patches, *layer.coverage, input.frame);
  }
}

void GlobeRenderer::draw_layers(const Pass& pass, SurfaceFromBelow look, DrawState state) const {
  const bool translucent = look != SurfaceFromBelow::opaque;
  if (translucent && !pass.further().empty()) return draw_layers_translucent(pass, state);
  if (translucent) state.blend = surface_blend(pass.input.surface);
  draw_first(pass, state);
  state.depth = kSameDepth;
  state.blend = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE};
  for (const LayerFrame& layer : pass.further()) draw_further(pass, layer, state);
}

// What lies below gives way first. Then layers add their part from the highest down, and the picture's alpha keeps what
// is left for those below them; at the end it is opaque again.
void GlobeRenderer::draw_layers_translucent(const Pass& pass, DrawState state) const {
  const auto flat = [&] {
    patches_->draw_flat(*pass.first().gpu, vertices_of(pass.first(), pass.first()), state, pass.counts);
  };
  state.blend = surface_blend(pass.input.surface);
  state.blend->from_rgb = GL_ZERO;
  state.blend->from_alpha = GL_CONSTANT_ALPHA;
  state.blend->to_alpha = GL_ZERO;
  flat();
  state.blend = {GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA};
  for (auto layer = pass.further().rbegin(); layer != pass.further().rend(); ++layer) draw_further(pass, *layer, state);
  draw_first(pass, state);
  state.blend.reset();
  state.color = {false, false, false, true};
  flat();
}

void GlobeRenderer::draw_first(const Pass& pass, const DrawState& state) const {
  const LayerFrame& first = pass.first();
  patches_->draw(*first.gpu, vertices_of(first, first), *first.tiles, state, pass.counts);
}

void GlobeRenderer::draw_further(const Pass& pass, const LayerFrame& layer, const DrawState& state) const {
  if (layer.patches->empty()) return;
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, layer.gpu->frame_block.name());
  patches_->draw_further(*layer.gpu, vertices_of(layer, pass.first()), *layer.tiles, layer.is_special(), state,
                         pass.counts);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
}

// Paper 2, (2.7) and (2.9).
BlendState GlobeRenderer::surface_blend(const SurfaceLook& look) {
  return {.from_rgb = GL_CONSTANT_ALPHA,
          .to_rgb = static_cast<GLenum>(look.blend == Blend::normal ? GL_ONE_MINUS_CONSTANT_ALPHA : GL_ONE),
          .from_alpha = GL_ZERO,
          .to_alpha = GL_ONE,
          .constant_alpha = static_cast<float>(look.alpha)};
}

// What a layer's programs know of its tiles.
void GlobeRenderer::describe_layer(const LayerFrame& layer, FrameBlock& block) const {
  const SlotLayout& layout = layer.tiles->layout();
  const TileGrid& grid = layer.tree->grid();
  const double polar_scale = grid.latitude == LatitudeKind::centric ? ellipsoid_.one_minus_e2() : 1.0;
  block.texels =
      glm::vec4(double(layout.tile_px) / layout.slot_px(), layout.slot_px(), layer.tiles->mips(), polar_scale);
  block.paper = glm::vec4(options_.paper_a, options_.paper_band, grid.projection == Projection::equal_area ? 1.0 : 0.0,
                          layer.opacity);
  const float side = layer.daylight == Daylight::day ? 1.0F : -1.0F;
  block.layer_look = glm::vec4(layer.daylight == Daylight::both ? 0.0F : side,
                               layer.alpha == AlphaFrom::brightness ? 1.0F : 0.0F, 0.0F, 0.0F);
}

void GlobeRenderer::upload_frame(const LayerFrame& layer) const {
  if (layer.patches->empty()) return;
  FrameBlock block = frame_;
  describe_layer(layer, block);
  gl::Buffer& buffer = layer.gpu->frame_block;
  if (!buffer) {
    buffer = gl::make_buffer();
    glNamedBufferStorage(buffer.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  glNamedBufferSubData(buffer.name(), 0, sizeof(block), &block);
}

}  // namespace terrella
