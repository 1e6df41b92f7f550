#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "render/gl/gl_handle.h"
#include "surface/patch_mesh.h"

namespace terrella {

/// The vertices of recently drawn patches in one GPU buffer with places of equal size, and the index lists that all
/// share. All views of a layer draw from it: a patch with the same heights has one place. thread: main
class PatchBuffers {
 public:
  /// `segments` a side of each patch. `heights`: grid of the heights; null: no relief.
  PatchBuffers(int segments, const TileGrid* heights);

  /// Sets the number of views that are drawn in turn.
  void set_views(int views) { views_ = static_cast<std::uint64_t>(views); }
  /// Returns the patch's place (vertices from place · vertices_per_patch()). Uploads the patch if it is not there with
  /// these heights, in place of the patch drawn longest ago. The places of each view's latest frame are kept: the
  /// buffer grows if these frames need more. All trees of the views are alike.
  [[nodiscard]] int place_of(const PatchTree& tree, const PatchNode& node, std::uint64_t frame);

  /// The vertices of a place in scaled space, where the ellipsoid is the unit sphere.
  [[nodiscard]] std::span<const glm::vec3> points(int place) const {
    return {points_.data() + static_cast<std::size_t>(place * vertices_per_patch_),
            static_cast<std::size_t>(vertices_per_patch_)};
  }
  /// False if the driver has no memory for the patches of a frame, which then cannot be drawn.
  [[nodiscard]] bool has_memory(std::uint64_t frame) const { return refused_in_ != frame; }
  [[nodiscard]] int vertices_per_patch() const { return vertices_per_patch_; }
  [[nodiscard]] int segments() const { return segments_; }
  [[nodiscard]] const PatchIndices& indices() const { return indices_; }
  [[nodiscard]] GLuint vertex_buffer() const { return vertices_.name(); }
  /// Two floats per vertex: height_offsets_deg(). Only with relief.
  [[nodiscard]] GLuint height_offset_buffer() const { return height_offsets_.name(); }
  [[nodiscard]] GLuint index_buffer() const { return index_buffer_.name(); }

 private:
  struct Mesh {
    PatchId patch;
    std::uint64_t heights = 0;  ///< PatchRelief::made
    bool operator==(const Mesh&) const = default;
  };
  struct MeshHash {
    [[nodiscard]] std::size_t operator()(const Mesh& mesh) const { return PatchIdHash()(mesh.patch) ^ mesh.heights; }
  };
  struct Place {
    Mesh mesh;
    int place = 0;
    std::uint64_t last_drawn = 0;
  };
  int free_place(std::uint64_t frame);
  [[nodiscard]] bool grow();
  void fill(const PatchTree& tree, const PatchNode& node, int place);

  std::optional<TileGrid> heights_;
  int segments_, vertices_per_patch_;
  PatchIndices indices_;
  gl::Buffer vertices_, height_offsets_;
  std::vector<glm::vec3> points_;
  gl::Buffer index_buffer_;
  std::uint64_t refused_in_ = 0;  ///< last frame in which the driver refused memory
  int capacity_ = 0;
  int used_ = 0;
  std::uint64_t views_ = 1;
  std::list<Place> by_age_;  // most recently drawn first
  std::unordered_map<Mesh, std::list<Place>::iterator, MeshHash> places_;
};

}  // namespace terrella
