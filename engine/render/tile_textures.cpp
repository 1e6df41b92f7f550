#include "render/tile_textures.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace terrella {
namespace {

constexpr int kFirstSlots = 128;
constexpr std::uint8_t kPlainColour[4] = {30, 38, 52, 255};

/// Pixels around the planet at a level, if that is a whole number.
std::optional<std::int64_t> pixels_around(const TileGrid& grid, int level) {
  const double exact = 360.0 / tile_span_deg(grid, level) * grid.tile_px;
  const double whole = std::round(exact);
  if (std::abs(exact - whole) > 1e-3) return std::nullopt;
  return static_cast<std::int64_t>(whole);
}

/// The tile beside another, over ±180° too; nothing beyond the poles or where columns do not close.
std::optional<TileId> beside(const TileGrid& grid, const TileId& id, int dx, int dy) {
  TileId other{id.level, id.x + dx, id.y + dy};
  if (other.y < 0 || other.y >= rows(grid, id.level)) return std::nullopt;
  const std::int64_t across = columns(grid, id.level);
  if (other.x < 0 || other.x >= across) {
    if (!pixels_around(grid, id.level)) return std::nullopt;
    other.x = (other.x + across) % across;
  }
  return other;
}

}  // namespace

TileTextures::TileTextures(const TileGrid& grid, const SlotLayout& layout, int mips, std::size_t budget_bytes)
    : grid_(grid), layout_(layout), mips_(mips) {
  GLint most_layers = 256;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);
  most_slots_ =
      static_cast<int>(std::clamp<std::size_t>(budget_bytes / slot_bytes(), 16, static_cast<std::size_t>(most_layers)));
  grow();
}

std::size_t TileTextures::slot_bytes() const {
  std::size_t bytes = 0;
  for (int k = 0; k < mips_; ++k)
    bytes += 4UL * static_cast<std::size_t>((layout_.slot_px() >> k) * (layout_.slot_px() >> k));
  return bytes;
}

bool TileTextures::grow() {
  const int slots = std::min(most_slots_, slots_ == 0 ? kFirstSlots : 2 * slots_);
  if (slots == slots_) return false;
  gl::Texture larger = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(larger.name(), mips_, GL_RGBA8, layout_.slot_px(), layout_.slot_px(), slots);
  for (int k = 0; k < mips_; ++k) {
    const int side = layout_.slot_px() >> k;
    if (texture_) {
      glCopyImageSubData(texture_.name(), GL_TEXTURE_2D_ARRAY, k, 0, 0, 0, larger.name(), GL_TEXTURE_2D_ARRAY, k, 0, 0,
                         0, side, side, slots_);
    } else {
      glClearTexSubImage(larger.name(), k, 0, 0, 0, side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE, kPlainColour);
    }
  }
  texture_ = std::move(larger);
  slots_ = slots;
  return true;
}

int TileTextures::take_slot(std::uint64_t frame) {
  if (!free_.empty()) {
    const int slot = free_.back();
    free_.pop_back();
    return slot;
  }
  if (used_ < slots_ || grow()) return used_++;
  const std::pair<const TileId, TileResidency::Entry>* oldest = nullptr;
  for (const auto& item : residency_.entries()) {
    const TileResidency::Entry& entry = item.second;
    if (entry.state != TileState::resident || item.first.level == grid_.min_level || entry.last_drawn >= frame)
      continue;
    // What the last frame's view needs would be asked for again at once; an ancestor that only stands in goes first.
    if (entry.last_needed + 1 >= frame) continue;
    if (oldest == nullptr || item.second.last_drawn < oldest->second.last_drawn) oldest = &item;
  }
  if (oldest == nullptr) return -1;
  const int slot = oldest->second.slot;
  residency_.erase(TileId(oldest->first));
  return slot;
}

bool TileTextures::upload(const TileId& id, const std::vector<std::vector<std::uint8_t>>& mips, std::uint64_t frame) {
  const TileResidency::Entry* there = residency_.find(id);
  const int slot = there != nullptr && there->state == TileState::resident ? there->slot : take_slot(frame);
  if (slot < 0) return false;
  for (int k = 0; k < mips_ && k < static_cast<int>(mips.size()); ++k) {
    const int side = layout_.slot_px() >> k;
    glTextureSubImage3D(texture_.name(), k, 0, 0, slot, side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        mips[static_cast<std::size_t>(k)].data());
  }
  TileResidency::Entry& entry = residency_.entry(id);
  entry.state = TileState::resident;
  entry.slot = slot;
  entry.last_drawn = frame;
  join_gutters(id);
  return true;
}

void TileTextures::join_gutters(const TileId& id) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const std::optional<TileId> other = beside(grid_, id, dx, dy);
      if (!other) continue;
      const TileResidency::Entry* entry = residency_.find(*other);
      if (entry == nullptr || entry->state != TileState::resident) continue;
      fill_gutter(id, *other, dx, dy);
      if (*other != id) fill_gutter(*other, id, -dx, -dy);
    }
  }
}

// Copies the strip of `from` that lies next to `into` on side (dx, dy) into that side's gutter, on every mip.
void TileTextures::fill_gutter(const TileId& into, const TileId& from, int dx, int dy) {
  const int to_layer = residency_.entry(into).slot, from_layer = residency_.entry(from).slot;
  // Where the last column reaches over +180° its own texels end before its edge.
  int end_px = grid_.tile_px;
  const std::int64_t across = columns(grid_, into.level);
  if (dx < 0 && into.x == 0)
    end_px = static_cast<int>(*pixels_around(grid_, into.level) - (across - 1) * grid_.tile_px);
  if (dx > 0 && into.x == across - 1 && *pixels_around(grid_, into.level) != across * grid_.tile_px) return;
  for (int k = 0; k < mips_; ++k) {
    const int g = layout_.gutter_px >> k, t = layout_.tile_px >> k, end = end_px >> k;
    if (g == 0 || end < g) return;
    const auto strip = [g, t](int d) { return d == 0 ? t : g; };
    const auto from_edge = [g](int d, int last) { return d < 0 ? last : g; };
    const auto to_edge = [g, t](int d) { return d < 0 ? 0 : d > 0 ? g + t : g; };
    glCopyImageSubData(texture_.name(), GL_TEXTURE_2D_ARRAY, k, from_edge(dx, end), from_edge(dy, t), from_layer,
                       texture_.name(), GL_TEXTURE_2D_ARRAY, k, to_edge(dx), to_edge(dy), to_layer, strip(dx),
                       strip(dy), 1);
  }
}

}  // namespace terrella
