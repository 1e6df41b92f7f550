#include "render/surface/slope_textures.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/packing.hpp>
#include <utility>

#include "render/gl/storage.h"

namespace terrella {
namespace {

constexpr int kFirstLayers = 8;  // a driver in software zeroes them
constexpr std::size_t kBudget_bytes = 64UL << 20;
constexpr float kSteepest = 1000.0F;  // a half float holds it, also where a gap of the data makes a cliff

template <class T>
void send(gl::Buffer& buffer, const std::vector<T>& data) {
  if (!buffer) buffer = gl::make_buffer();
  glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

}  // namespace

SlopeTextures::SlopeTextures(const TileGrid& grid) : grid_(grid), sampler_(gl::make_sampler()) {
  set_views(1);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glSamplerParameteri(sampler_.name(), filter, GL_LINEAR);
  }
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    glSamplerParameteri(sampler_.name(), wrap, GL_CLAMP_TO_EDGE);
  }
  static_cast<void>(grow());
}

void SlopeTextures::set_views(int views) {
  if (!has_memory_) return;
  GLint most = 256;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
  const std::size_t layer_bytes = sizeof(std::uint32_t) * static_cast<std::size_t>(slot_px() * slot_px());
  const std::size_t wanted = static_cast<std::size_t>(views) * kBudget_bytes / layer_bytes;
  most_layers_ =
      std::max(layers_, static_cast<int>(std::clamp<std::size_t>(wanted, 64, static_cast<std::size_t>(most))));
}

bool SlopeTextures::grow() {
  const int layers = std::min(most_layers_, layers_ == 0 ? kFirstLayers : 2 * layers_);
  if (layers == layers_) return false;
  gl::Texture larger = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(larger.name(), 1, GL_RG16F, slot_px(), slot_px(), layers);
  if (!gl::has_storage(larger)) {
    has_memory_ = false;
    most_layers_ = layers_;
    return false;
  }
  if (texture_) {
    glCopyImageSubData(texture_.name(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, larger.name(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0,
                       slot_px(), slot_px(), layers_);
  } else {
    glClearTexSubImage(larger.name(), 0, 0, 0, 0, slot_px(), slot_px(), 1, GL_RG, GL_FLOAT, nullptr);
  }
  texture_ = std::move(larger);
  layers_ = layers;
  return true;
}

// Returns 0 if this frame uses all layers.
int SlopeTextures::free_layer(std::uint64_t frame) {
  if (used_ < layers_ || grow()) return used_++;
  const auto oldest = std::ranges::min_element(slots_, {}, [](const auto& slot) { return slot.second.last_used; });
  if (oldest == slots_.end() || oldest->second.last_used == frame) return 0;
  const int layer = oldest->second.layer;
  slots_.erase(oldest);
  return layer;
}

int SlopeTextures::layer_of(const Relief& relief, const TileId& id, std::uint64_t frame) {
  auto found = slots_.find(id);
  if (found == slots_.end()) {
    const int layer = free_layer(frame);
    if (layer == 0) return 0;
    found = slots_.emplace(id, Slot{.layer = layer}).first;
  } else if (found->second.last_used == frame || !relief.changed_since(id, found->second.changes_seen)) {
    found->second.last_used = frame;
    return found->second.layer;
  }
  found->second.last_used = frame;
  found->second.changes_seen = relief.changes_seen();
  const std::vector<glm::vec2> slopes = relief.field().slopes(id, kGutter_px);
  std::vector<std::uint32_t> texels;
  texels.reserve(slopes.size());
  for (const glm::vec2& slope : slopes) {
    texels.push_back(glm::packHalf2x16(glm::clamp(slope, -kSteepest, kSteepest)));
  }
  glTextureSubImage3D(texture_.name(), 0, 0, 0, found->second.layer, slot_px(), slot_px(), 1, GL_RG, GL_HALF_FLOAT,
                      texels.data());
  return found->second.layer;
}

// The tile itself, or an ancestor if all layers are in use.
WindowCell SlopeTextures::cell_of(const Relief& relief, TileId id, std::uint64_t frame) {
  for (int up = 0;; ++up, id = parent(id)) {
    const int layer = layer_of(relief, id, frame);
    if (layer != 0 || id.level <= grid_.min_level) return window_cell(layer, up, up);
  }
}

void SlopeTextures::upload(PatchLayer& layer, const Relief& relief, const PatchTree& tree,
                           const std::vector<SelectedPatch>& patches, std::uint64_t frame) {
  std::vector<SlopeDraw> draws;
  std::vector<WindowCell> cells;
  draws.reserve(patches.size());
  for (const SelectedPatch& patch : patches) {
    const SlopeWindow window = slope_window(relief, tree, patch);
    const auto low = [](std::int64_t n) { return static_cast<std::uint32_t>(n & 0xFFFFFF); };
    const auto size = static_cast<std::uint32_t>(window.w) | static_cast<std::uint32_t>(window.h) << 16U;
    draws.push_back({window.center_and_scale, {cells.size(), size, low(window.x0), low(window.y0)}});
    for (int y = 0; y < window.h; ++y) {
      for (int x = 0; x < window.w; ++x) {
        cells.push_back(cell_of(relief, {window.level, window.x0 + x, window.y0 + y}, frame));
      }
    }
  }
  send(layer.slope_draws, draws);
  send(layer.slope_cells, cells);
  if (!layer.slope_cells_texture) layer.slope_cells_texture = gl::make_texture(GL_TEXTURE_BUFFER);
  glTextureBuffer(layer.slope_cells_texture.name(), GL_R32UI, layer.slope_cells.name());
}

void SlopeTextures::bind(const PatchLayer& layer) const {
  glBindTextureUnit(kUnit, texture_.name());
  glBindSampler(kUnit, sampler_.name());
  glBindTextureUnit(kCellsUnit, layer.slope_cells_texture.name());
  glBindSampler(kCellsUnit, 0);
}

}  // namespace terrella
