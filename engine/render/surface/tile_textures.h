#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <vector>

#include "render/gl/gl_handle.h"
#include "surface/plan/tile_coverage.h"
#include "tiles/number_texels.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_residency.h"

namespace terrella {

/// The layout of a texture slot: tile_px texels per side inside a gutter, slot_px per side in total. A layer of the
/// array texture is a square of slots.
struct SlotLayout {
  int tile_px = 256;
  int gutter_px = 8;
  int slots_a_side = 1;  ///< slots per side of an array layer: a power of two, at most kMostSlotsASide
  std::optional<NumberSlots> numbers = {};  ///< set: texels are numbers, R16 or R32F; none: pictures, RGBA8
  [[nodiscard]] int slot_px() const { return tile_px + 2 * gutter_px; }
  [[nodiscard]] int layer_px() const { return slots_a_side * slot_px(); }
  [[nodiscard]] int slots_a_layer() const { return slots_a_side * slots_a_side; }
  /// Texels per side that a tile fills in a slot's mip: less than the mip's size if the gutter does not halve evenly.
  [[nodiscard]] int mip_px(int k) const { return (tile_px >> k) + 2 * (gutter_px >> k); }
};

/// Texture slots for tiles: one array texture that grows up to a budget and evicts the least recently drawn tile. Once
/// the driver's array textures have too few layers, a layer holds several slots side by side. There are fewer slots
/// than the budget allows if the driver has no memory for more. Slot 0 is a plain colour or transparent, for numbers
/// "no data", for places without imagery. A slot's gutter receives the texels of neighbouring tiles as they arrive, so
/// that filtering continues across a tile's border. thread: main
class TileTextures {
 public:
  /// A slot is a number of 16 bits: its layer in the array, its column (2 bits) and its row (2 bits) in that layer.
  static constexpr int kLayerBits = 12, kMostSlotsASide = 4;

  TileTextures(const TileGrid& grid, const SlotLayout& layout, int mips, std::size_t budget_bytes);

  /// The content of slot 0. Initially it is the plain colour.
  enum class Empty { plain_colour, transparent };
  void set_empty(Empty empty);
  /// Sets the budget and evicts the tiles drawn longest ago if there is less room.
  void set_budget(std::size_t bytes);

  /// Puts a tile into a slot: `mips` finest first, slot_px >> k texels per side (tiles/tile_texels.h). If the
  /// budget is used up, evicts the tile drawn longest ago, but never a tile of the coarsest level or of `frame`. False
  /// if there is no room.
  bool upload(const TileId& id, const std::vector<std::vector<std::uint8_t>>& mips, std::uint64_t frame);

  /// Joins gutters of rows of different squeeze again if tiles have arrived since. Such gutters are averages that reach
  /// into the gutters beside them, so they depend on the order of arrival.
  void join_squeezed_again();
  /// Forgets all tiles, as if none had been uploaded. Keeps the texture.
  void forget_tiles();

  /// Reads back one texel of a resident tile of numbers, counted from the tile's north-west corner; waits for the GPU.
  /// NaN if it has no data.
  [[nodiscard]] double number_at(const TileId& id, int x, int y) const;

  [[nodiscard]] TileResidency& residency() { return residency_; }
  [[nodiscard]] const TileResidency& residency() const { return residency_; }
  [[nodiscard]] GLuint texture() const { return texture_.name(); }
  [[nodiscard]] const SlotLayout& layout() const { return layout_; }
  [[nodiscard]] int mips() const { return mips_; }
  /// Number of tiles that fit in the budget, with slot 0; 0: the driver has no memory for any.
  [[nodiscard]] int capacity() const { return most_slots_; }
  [[nodiscard]] bool memory_refused() const { return memory_refused_; }  ///< since the last set_budget()
  [[nodiscard]] int free_slots() const { return most_slots_ - used_; }   ///< tiles that fit without evicting one
  [[nodiscard]] std::size_t slot_bytes() const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  [[nodiscard]] int slots_a_side_for(std::size_t slots) const;
  [[nodiscard]] int slots_for(std::size_t bytes) const;
  [[nodiscard]] int slot(int number) const;
  int take_slot(std::uint64_t frame);
  bool grow();
  bool make_anew(int slots);
  void copy_layers(const gl::Texture& from, int layers) const;
  void move_tiles(const gl::Texture& from, const SlotLayout& before);
  void paint_empty();
  [[nodiscard]] bool is_resident(const TileId& id) const;
  void join_gutters(const TileId& id);
  void join_row(const TileId& id, int dy);
  void join_squeezed_row(const TileId& id, int dy);
  void join_squeezed(const TileId& wide, const TileId& narrow, int dy);
  void fill_gutter(const TileId& into, const TileId& from, int dx, int dy);
  void stretch_gutter(const TileId& into, const TileId& from, int dy, int half);

  TileGrid grid_;
  SlotLayout layout_;
  int mips_;
  int most_slots_;
  int slots_ = 0;  ///< slots of the array, at most most_slots_
  bool memory_refused_ = false;
  bool joined_ = true;  ///< no tile has arrived since join_squeezed_again()
  int used_ = 1;
  Empty empty_ = Empty::plain_colour;
  gl::Texture texture_;
  gl::Framebuffer stretch_from_, stretch_into_;  ///< made when rows of different squeeze first meet
  TileResidency residency_;
};

}  // namespace terrella
