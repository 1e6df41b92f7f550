#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <unordered_map>

#include "render/gl/gl_handle.h"
#include "surface/patch_mesh.h"

namespace terrella {

/// The vertices of recently drawn patches in one GPU buffer with places of equal size, and the index lists that all
/// share. thread: main
class PatchBuffers {
 public:
  /// `heights`: grid of the heights; null: no relief.
  PatchBuffers(const PatchTree& tree, const TileGrid* heights);

  /// Returns the patch's place (vertices from place · vertices_per_patch()). Uploads the patch if it is not there or if
  /// its heights have changed, in place of the patch drawn longest ago. Places used in the current frame are kept: the
  /// buffer grows if one frame needs more.
  [[nodiscard]] int place_of(const PatchNode& node, std::uint64_t frame);

  [[nodiscard]] int vertices_per_patch() const { return vertices_per_patch_; }
  [[nodiscard]] const PatchIndices& indices() const { return indices_; }
  [[nodiscard]] GLuint vertex_buffer() const { return vertices_.name(); }
  /// Two floats per vertex: height_offsets_deg(). Only with relief.
  [[nodiscard]] GLuint height_offset_buffer() const { return height_offsets_.name(); }
  [[nodiscard]] GLuint index_buffer() const { return index_buffer_.name(); }

 private:
  struct Place {
    std::uint64_t node = 0;  ///< PatchNode::serial
    int place = 0;
    std::uint64_t last_drawn = 0;
    std::uint64_t relief_made = 0;
  };
  int free_place(std::uint64_t frame);
  void grow();
  void fill(const PatchNode& node, int place);

  const PatchTree& tree_;
  std::optional<TileGrid> heights_;
  int vertices_per_patch_;
  PatchIndices indices_;
  gl::Buffer vertices_, height_offsets_;
  gl::Buffer index_buffer_;
  int capacity_ = 0;
  int used_ = 0;
  std::list<Place> by_age_;  // most recently drawn first
  std::unordered_map<std::uint64_t, std::list<Place>::iterator> places_;
};

}  // namespace terrella
