#include "render/surface/tile_textures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "render/gl/draw_state.h"
#include "render/gl/storage.h"

namespace terrella {
namespace {

// Slots of a new array: enough for a small picture of a planet, and a driver in software zeroes all of them.
constexpr int kFirstSlots = 16;
// Fewest slots that are asked for once there is no memory for more.
constexpr int kLeastMore = 8;
constexpr std::uint8_t kPlainColour[4] = {30, 38, 52, 255};

/// OpenGL's formats for the texels of a layout: the stored one, and that of the bytes uploaded.
struct TexelFormat {
  GLenum stored, channels, type;
  std::size_t bytes;
};
TexelFormat format_of(const SlotLayout& layout) {
  if (!layout.numbers) return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
  if (layout.numbers->codes) return {GL_R16, GL_RED, GL_UNSIGNED_SHORT, 2};
  return {GL_R32F, GL_RED, GL_FLOAT, 4};
}

/// A limit of the driver.
int most(GLenum limit) {
  GLint value = 256;
  glGetIntegerv(limit, &value);
  return value;
}

/// Layers of an array that a slot's number can name and the driver has.
std::size_t most_layers() {
  return static_cast<std::size_t>(std::min(most(GL_MAX_ARRAY_TEXTURE_LAYERS), 1 << TileTextures::kLayerBits));
}

/// The place of a slot: the corner of its mip `k`, and its layer.
struct SlotCorner {
  GLint x, y, layer;
};
SlotCorner corner_of(const SlotLayout& layout, int slot, int k) {
  const int side = layout.slot_px() >> k, at = slot >> TileTextures::kLayerBits;
  return {(at & 3) * side, (at >> 2) * side, slot & ((1 << TileTextures::kLayerBits) - 1)};
}

int layers_for(const SlotLayout& layout, int slots) {
  return (slots + layout.slots_a_layer() - 1) / layout.slots_a_layer();
}

/// Returns the number of texels around the planet in the tiles of a level and squeeze, if the columns close at ±180°.
std::optional<std::int64_t> texels_around(const TileGrid& grid, int level, int squeeze) {
  const double exact = std::ldexp(360.0 / tile_span_deg(grid, level) * grid.tile_px, -squeeze);
  const double whole = std::round(exact);
  if (grid.west_deg != -180.0 || std::abs(exact - whole) > 1e-3) return std::nullopt;
  return static_cast<std::int64_t>(whole);
}

/// Returns the neighbour of a tile in a row of the same squeeze, also across ±180°; nothing if the columns do not close
/// there.
std::optional<TileId> beside(const TileGrid& grid, const TileId& id, int dx, int dy) {
  TileId other{id.level, id.x + dx, id.y + dy, id.squeeze};
  const std::int64_t across = squeezed_columns(grid, id.level, id.squeeze);
  if (other.x < 0 || other.x >= across) {
    if (!texels_around(grid, id.level, id.squeeze)) return std::nullopt;
    other.x = (other.x + across) % across;
  }
  return other;
}

}  // namespace

TileTextures::TileTextures(const TileGrid& grid, const SlotLayout& layout, int mips, std::size_t budget_bytes)
    : grid_(grid), layout_(layout), mips_(mips), most_slots_(slots_for(budget_bytes)) {
  grow();
}

// As few as so many slots need. Each mip of a slot must begin at a whole texel and have a gutter.
int TileTextures::slots_a_side_for(std::size_t slots) const {
  const int coarsest = 1 << (mips_ - 1);
  const bool whole = layout_.slot_px() % coarsest == 0 && layout_.gutter_px >= coarsest;
  int side = 1;
  while (whole && side < kMostSlotsASide && slots > most_layers() * side * side &&
         2 * side * layout_.slot_px() <= most(GL_MAX_TEXTURE_SIZE)) {
    side *= 2;
  }
  return side;
}

int TileTextures::slots_for(std::size_t bytes) const {
  const std::size_t fit = std::max<std::size_t>(bytes / slot_bytes(), 16);
  const int side = slots_a_side_for(fit);
  return static_cast<int>(std::min(fit, most_layers() * side * side));
}

// Returns the slot that is the n-th to be used: layer by layer.
int TileTextures::slot(int number) const {
  const int a_layer = layout_.slots_a_layer(), in_layer = number % a_layer;
  return number / a_layer | (in_layer % layout_.slots_a_side) << kLayerBits |
         (in_layer / layout_.slots_a_side) << (kLayerBits + 2);
}

void TileTextures::set_empty(Empty empty) {
  if (empty == empty_) return;
  empty_ = empty;
  paint_empty();
}

void TileTextures::paint_empty() {
  constexpr std::uint8_t kNothing[4] = {0, 0, 0, 0};
  const TexelFormat format = format_of(layout_);
  const auto none = static_cast<std::uint16_t>(layout_.numbers ? layout_.numbers->none : 0);
  const void* texel = empty_ == Empty::plain_colour ? kPlainColour : kNothing;
  if (layout_.numbers) texel = layout_.numbers->codes ? static_cast<const void*>(&none) : &kNoNumber;
  for (int k = 0; k < mips_; ++k) {
    const int side = layout_.slot_px() >> k;
    glClearTexSubImage(texture_.name(), k, 0, 0, 0, side, side, 1, format.channels, format.type, texel);
  }
}

// Copies the first layers with all mips.
void TileTextures::copy_layers(const gl::Texture& from, int layers) const {
  for (int k = 0; k < mips_; ++k) {
    const int side = layout_.layer_px() >> k;
    glCopyImageSubData(from.name(), GL_TEXTURE_2D_ARRAY, k, 0, 0, 0, texture_.name(), GL_TEXTURE_2D_ARRAY, k, 0, 0, 0,
                       side, side, layers);
  }
}

void TileTextures::set_budget(std::size_t bytes) {
  memory_refused_ = false;
  most_slots_ = slots_for(bytes);
  if (slots_ > most_slots_ && !make_anew(most_slots_)) most_slots_ = slots_;
}

// Makes the array with so many slots. False, with the array as it is, if there is no memory for both.
bool TileTextures::make_anew(int slots) {
  const SlotLayout before = layout_;
  const int layers_before = layers_for(layout_, slots_);
  SlotLayout after = layout_;
  after.slots_a_side = slots_a_side_for(static_cast<std::size_t>(slots));
  gl::Texture array = gl::make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(array.name(), mips_, format_of(after).stored, after.layer_px(), after.layer_px(),
                     layers_for(after, slots));
  if (!gl::has_storage(array)) {
    memory_refused_ = true;
    return false;
  }
  const gl::Texture old = std::exchange(texture_, std::move(array));
  const bool is_longer = old && slots > slots_ && after.slots_a_side == before.slots_a_side;
  layout_ = after;
  slots_ = slots;
  if (is_longer) {
    copy_layers(old, layers_before);
  } else {
    paint_empty();
    move_tiles(old, before);
  }
  return true;
}

// Moves the tiles from an earlier array, as many as there are slots: those of the coarsest level first, then the most
// recently drawn.
void TileTextures::move_tiles(const gl::Texture& from, const SlotLayout& before) {
  std::vector<std::pair<TileId, TileResidency::Entry*>> tiles;
  for (auto& [id, entry] : residency_.entries()) {
    if (entry.state == TileState::resident) tiles.emplace_back(id, &entry);
  }
  std::ranges::sort(tiles, [&](const auto& a, const auto& b) {
    const bool a_root = a.first.level == grid_.min_level, b_root = b.first.level == grid_.min_level;
    return a_root != b_root ? a_root : a.second->last_drawn > b.second->last_drawn;
  });
  used_ = 1;
  for (const auto& [id, entry] : tiles) {
    if (used_ == slots_) {
      residency_.erase(id);
      continue;
    }
    const int from_slot = std::exchange(entry->slot, slot(used_++));
    for (int k = 0; k < mips_; ++k) {
      const SlotCorner a = corner_of(before, from_slot, k), b = corner_of(layout_, entry->slot, k);
      glCopyImageSubData(from.name(), GL_TEXTURE_2D_ARRAY, k, a.x, a.y, a.layer, texture_.name(), GL_TEXTURE_2D_ARRAY,
                         k, b.x, b.y, b.layer, layout_.slot_px() >> k, layout_.slot_px() >> k, 1);
    }
  }
}

std::size_t TileTextures::slot_bytes() const {
  std::size_t texels = 0;
  for (int k = 0; k < mips_; ++k)
    texels += static_cast<std::size_t>((layout_.slot_px() >> k) * (layout_.slot_px() >> k));
  return texels * format_of(layout_).bytes;
}

std::size_t TileTextures::bytes() const {
  return static_cast<std::size_t>(layers_for(layout_, slots_) * layout_.slots_a_layer()) * slot_bytes();
}

// If there is no memory for twice as many slots, tries to get fewer more, and then goes on with those that are there.
bool TileTextures::grow() {
  const int wanted = slots_ == 0 ? kFirstSlots : 2 * slots_;
  for (int more = std::min(most_slots_, wanted) - slots_; more > 0; more = more > kLeastMore ? more / 2 : 0) {
    if (make_anew(slots_ + more)) return true;
  }
  most_slots_ = slots_;
  return false;
}

int TileTextures::take_slot(std::uint64_t frame) {
  if (used_ < slots_ || grow()) return slot(used_++);
  const std::optional<TileId> oldest = residency_.to_evict(frame, grid_.min_level);
  if (!oldest) return -1;
  const int slot = residency_.entry(*oldest).slot;
  residency_.erase(*oldest);
  return slot;
}

bool TileTextures::upload(const TileId& id, const std::vector<std::vector<std::uint8_t>>& mips, std::uint64_t frame) {
  const TileResidency::Entry* there = residency_.find(id);
  const int slot = there != nullptr && there->state == TileState::resident ? there->slot : take_slot(frame);
  if (slot < 0) return false;
  const TexelFormat format = format_of(layout_);
  if (format.bytes == 2) glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
  for (int k = 0; k < mips_ && k < static_cast<int>(mips.size()); ++k) {
    const int side = layout_.mip_px(k);
    const SlotCorner at = corner_of(layout_, slot, k);
    glTextureSubImage3D(texture_.name(), k, at.x, at.y, at.layer, side, side, 1, format.channels, format.type,
                        mips[static_cast<std::size_t>(k)].data());
  }
  if (format.bytes == 2) glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  TileResidency::Entry& entry = residency_.entry(id);
  entry.state = TileState::resident;
  entry.slot = slot;
  entry.last_drawn = frame;
  joined_ = false;
  join_gutters(id);
  return true;
}

void TileTextures::forget_tiles() {
  residency_.entries().clear();
  used_ = 1;
}

double TileTextures::number_at(const TileId& id, int x, int y) const {
  const TileResidency::Entry* entry = residency_.find(id);
  assert(layout_.numbers && entry != nullptr && entry->state == TileState::resident);
  const TexelFormat format = format_of(layout_);
  const int gutter = layout_.gutter_px;
  const SlotCorner at = corner_of(layout_, entry->slot, 0);
  std::uint16_t code = 0;
  float number = 0.0F;
  void* texel = layout_.numbers->codes ? static_cast<void*>(&code) : &number;
  glGetTextureSubImage(texture_.name(), 0, at.x + gutter + x, at.y + gutter + y, at.layer, 1, 1, 1, format.channels,
                       format.type, static_cast<GLsizei>(format.bytes), texel);
  return number_of(*layout_.numbers, layout_.numbers->codes ? code : static_cast<double>(number));
}

bool TileTextures::is_resident(const TileId& id) const {
  const TileResidency::Entry* entry = residency_.find(id);
  return entry != nullptr && entry->state == TileState::resident;
}

void TileTextures::join_gutters(const TileId& id) {
  for (int dy = -1; dy <= 1; ++dy) {
    const std::int64_t y = id.y + dy;
    if (y < 0 || y >= rows(grid_, id.level)) continue;
    if (squeeze_of_row(grid_, id.level, y) == id.squeeze || id.squeeze == 0) join_row(id, dy);
    join_squeezed_row(id, dy);
  }
}

// Joins gutters with the neighbours in a row of the next squeeze.
void TileTextures::join_squeezed_row(const TileId& id, int dy) {
  const std::int64_t y = id.y + dy;
  const int squeeze = squeeze_of_row(grid_, id.level, y);
  if (squeeze == id.squeeze + 1) {
    join_squeezed({id.level, id.x >> 1, y, squeeze}, id, -dy);
  } else if (squeeze == id.squeeze - 1) {
    for (const std::int64_t x : {2 * id.x, 2 * id.x + 1}) join_squeezed(id, {id.level, x, y, squeeze}, dy);
  }
}

void TileTextures::join_squeezed_again() {
  if (std::exchange(joined_, true) || !grid_.reduced) return;
  for (const auto& [id, entry] : residency_.entries()) {
    if (entry.state != TileState::resident) continue;
    for (const int dy : {-1, 1}) {
      if (id.y + dy >= 0 && id.y + dy < rows(grid_, id.level)) join_squeezed_row(id, dy);
    }
  }
}

// Joins gutters with the neighbours in a row of the same squeeze.
void TileTextures::join_row(const TileId& id, int dy) {
  for (int dx = -1; dx <= 1; ++dx) {
    if (dx == 0 && dy == 0) continue;
    const std::optional<TileId> other = beside(grid_, id, dx, dy);
    if (!other || !is_resident(*other)) continue;
    fill_gutter(id, *other, dx, dy);
    if (*other != id) fill_gutter(*other, id, -dx, -dy);
  }
}

// Joins gutters of a wide tile and one of the two narrower tiles along its side `dy`.
void TileTextures::join_squeezed(const TileId& wide, const TileId& narrow, int dy) {
  if (!is_resident(wide) || !is_resident(narrow)) return;
  const int half = static_cast<int>(narrow.x & 1);
  stretch_gutter(wide, narrow, dy, half);
  stretch_gutter(narrow, wide, -dy, half);
}

// Fills the gutter on side `dy` from a tile twice or half as wide. Bilinear filtering averages two texels into one, or
// interpolates two texels into four. Numbers are taken from the nearest texel, so that "no data" is never averaged.
void TileTextures::stretch_gutter(const TileId& into, const TileId& from, int dy, int half) {
  if (!stretch_from_) {
    stretch_from_ = gl::make_framebuffer();
    stretch_into_ = gl::make_framebuffer();
  }
  const bool narrower = from.squeeze < into.squeeze;
  apply({});  // a scissor would cut the copy
  for (int k = 0; k < mips_; ++k) {
    const int g = layout_.gutter_px >> k, t = layout_.tile_px >> k;
    if (g == 0) return;
    const int from_x = narrower ? g : g + half * t / 2, from_w = narrower ? t : t / 2;
    const int into_x = narrower ? g + half * t / 2 : g, into_w = narrower ? t / 2 : t;
    const int from_y = dy < 0 ? t : g, into_y = dy < 0 ? 0 : g + t;
    const SlotCorner a = corner_of(layout_, residency_.entry(from).slot, k);
    const SlotCorner b = corner_of(layout_, residency_.entry(into).slot, k);
    glNamedFramebufferTextureLayer(stretch_from_.name(), GL_COLOR_ATTACHMENT0, texture_.name(), k, a.layer);
    glNamedFramebufferTextureLayer(stretch_into_.name(), GL_COLOR_ATTACHMENT0, texture_.name(), k, b.layer);
    glBlitNamedFramebuffer(stretch_from_.name(), stretch_into_.name(), a.x + from_x, a.y + from_y,
                           a.x + from_x + from_w, a.y + from_y + g, b.x + into_x, b.y + into_y, b.x + into_x + into_w,
                           b.y + into_y + g, GL_COLOR_BUFFER_BIT, layout_.numbers ? GL_NEAREST : GL_LINEAR);
  }
}

// Copies the strip of `from` beside `into` on side (dx, dy) into that side's gutter, on every mip.
void TileTextures::fill_gutter(const TileId& into, const TileId& from, int dx, int dy) {
  // If the last column extends over +180°, its own texels end before its edge.
  int end_px = grid_.tile_px;
  const std::int64_t across = squeezed_columns(grid_, into.level, into.squeeze);
  if (dx < 0 && into.x == 0) {
    end_px = static_cast<int>(*texels_around(grid_, into.level, into.squeeze) - (across - 1) * grid_.tile_px);
  } else if (dx > 0 && into.x == across - 1 &&
             *texels_around(grid_, into.level, into.squeeze) != across * grid_.tile_px) {
    return;
  }
  for (int k = 0; k < mips_; ++k) {
    const int g = layout_.gutter_px >> k, t = layout_.tile_px >> k, end = end_px >> k;
    if (g == 0 || end < g) return;
    const auto strip = [g, t](int d) { return d == 0 ? t : g; };
    const auto from_edge = [g](int d, int last) { return d < 0 ? last : g; };
    const auto to_edge = [g, t](int d) { return d < 0 ? 0 : d > 0 ? g + t : g; };
    const SlotCorner a = corner_of(layout_, residency_.entry(from).slot, k);
    const SlotCorner b = corner_of(layout_, residency_.entry(into).slot, k);
    glCopyImageSubData(texture_.name(), GL_TEXTURE_2D_ARRAY, k, a.x + from_edge(dx, end), a.y + from_edge(dy, t),
                       a.layer, texture_.name(), GL_TEXTURE_2D_ARRAY, k, b.x + to_edge(dx), b.y + to_edge(dy), b.layer,
                       strip(dx), strip(dy), 1);
  }
}

}  // namespace terrella
