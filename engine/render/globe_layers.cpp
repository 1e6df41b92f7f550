#include <algorithm>

#include "render/globe_renderer.h"

// The image layers before they are drawn: their programs, the stacks that combine them, and uploads.
namespace terrella {

Status GlobeRenderer::prepare_layers(const Pass& pass) {
  patches_->set_scene(scene_of(pass));
  plan_stacks(pass);
  for (std::size_t k = 0; k < pass.input.layers.size(); ++k) {
    const LayerFrame& layer = pass.input.layers[k];
    const TexelKind kind = kind_of(layer.gpu->numbers);
    if (Status s = patches_->prepare(pass.role_of(layer), kind, *layer.patches, stacks_.own[k]); !s) return s;
  }
  if (has_blends(pass) && surface_look(pass) != SurfaceFromBelow::opaque) {
    if (Status s = patches_->prepare_whole(PatchPass::Whole::behind); !s) return s;
  }
  return patches_->prepare(stacks_);
}

// Layers up to the first that has other rows than the base layer, or a shadow, or light of its own that the base
// layer's vertices do not have, or that reads the picture below it, or layers of directions. A translucent surface is
// drawn layer by layer.
void GlobeRenderer::plan_stacks(const Pass& pass) {
  const auto& layers = pass.input.layers;
  stack_layers_.clear();
  std::size_t stacked = 0;
  // Formulas of paper 1 are for comparison.
  const bool opaque = options_.texturing != Texturing::paper && pass.input.surface.alpha >= 1.0 &&
                      !pass.input.naive_translucency && !pass.input.layers_one_by_one &&
                      kind_of(pass.base().gpu->numbers) != TexelKind::directions;
  for (const LayerFrame& layer : layers) {
    const bool night = layer.daylight == Daylight::night;
    stack_layers_.push_back({.patches = layer.patches,
                             .coverage = layer.coverage,
                             .tiles = layer.tiles,
                             .numbers = layer.gpu->numbers,
                             .texels = texels_of(layer),
                             .opacity = static_cast<float>(layer.opacity),
                             .look = look_of(pass, layer),
                             .tone = tone_of(layer),
                             .special = layer.special,
                             .hides = layer.hides});
    const bool fits = &layer == &layers.front() ||
                      (shares_vertices(layer, layers.front()) && !(layer.height_m > 0.0 && pass.input.lit) &&
                       (!night || options_.night_lights) && layer.blend == LayerBlend::normal &&
                       kind_of(layer.gpu->numbers) != TexelKind::directions);
    if (opaque && fits && stacked + 1 == stack_layers_.size()) ++stacked;
  }
  // Objects on the ground come with the last layer of a patch, unless a layer is drawn by itself after it.
  const auto alone = std::span(layers).subspan(std::max<std::size_t>(1, stacked));
  ground_in_stacks_ =
      opaque && std::ranges::all_of(alone, [&](const LayerFrame& layer) { return is_over_ground(pass, layer); });
  patches_->plan(stack_layers_, stacked, ground_in_stacks_ ? pass.input.ground : nullptr, stacks_);
}

// An upper layer shares the vertices of the base layer if the rows of both grids count the same latitude.
bool GlobeRenderer::shares_vertices(const LayerFrame& layer, const LayerFrame& base) {
  const TileGrid &grid = layer.tree->grid(), &rows = base.tree->grid();
  return &layer != &base && grid.projection == rows.projection && grid.latitude == rows.latitude;
}

Status GlobeRenderer::upload_layers(const FrameInput& input) {
  const LayerFrame& base = input.layers.front();
  const bool shaded = input.relief != nullptr && input.lit;
  if (shaded && !slopes_) slopes_ = std::make_unique<SlopeTextures>(input.relief->grid());
  if (slopes_) slopes_->set_views(input.views);
  for (std::size_t k = 0; k < input.layers.size(); ++k) {
    const LayerFrame& layer = input.layers[k];
    const bool shares = shares_vertices(layer, base);
    std::unique_ptr<PatchBuffers>& own = *layer.vertices;
    if (shares) {
      own.reset();
    } else if (!own) {
      own = std::make_unique<PatchBuffers>(layer.tree->segments(),
                                           input.relief != nullptr ? &input.relief->grid() : nullptr);
    }
    if (own) own->set_views(input.views);
    patches_->upload(*layer.gpu, {vertices_of(layer, base), own ? *layer.tree : *base.tree, own != nullptr},
                     *layer.patches, *layer.coverage, stacks_.own[k], input.frame);
    if (!vertices_of(layer, base).has_memory(input.frame)) {
      return Error{"Globe::render: the driver has no memory for the vertices of the ground; draw a smaller picture"};
    }
    if (shaded) slopes_->upload(*layer.gpu, *input.relief, *layer.tree, *layer.patches, input.frame);
  }
  if (input.ground != nullptr) {
    patches_->upload_ground(*input.ground_gpu, *input.ground, {vertices_of(base, base), *base.tree, true},
                            *base.patches, input.frame);
  }
  patches_->upload(stacks_, stack_layers_, {vertices_of(base, base), *base.tree, true}, input.frame);
  return Done{};
}

}  // namespace terrella
