#include "render/surface/patch_buffers.h"

#include "geo/scaled_space.h"
#include "render/gl/storage.h"
#include "surface/slope_window.h"

namespace terrella {
namespace {
// Places of a new buffer: enough for a small picture, and a driver in software zeroes all of them.
constexpr int kFirstCapacity = 64;
// Patches that are kept although no view draws them any more.
constexpr int kKept = 512;
}  // namespace

PatchBuffers::PatchBuffers(int segments, const TileGrid* heights)
    : heights_(heights != nullptr ? std::optional(*heights) : std::nullopt),
      segments_(segments),
      vertices_per_patch_((segments + 1) * (segments + 1)),
      indices_(patch_indices(segments)),
      index_buffer_(gl::make_buffer()) {
  glNamedBufferStorage(index_buffer_.name(), static_cast<GLsizeiptr>(indices_.indices.size() * sizeof(std::uint16_t)),
                       indices_.indices.data(), 0);
  points_.resize(static_cast<std::size_t>(vertices_per_patch_));
  static_cast<void>(grow());  // place_of() tries again
}

bool PatchBuffers::grow() {
  const int capacity = capacity_ == 0 ? kFirstCapacity : 2 * capacity_;
  const auto enlarged = [&](const gl::Buffer& buffer, std::size_t vertex_bytes) {
    const auto bytes = [&](int patches) {
      return static_cast<GLsizeiptr>(patches) * vertices_per_patch_ * static_cast<GLsizeiptr>(vertex_bytes);
    };
    gl::Buffer larger = gl::make_buffer();
    glNamedBufferStorage(larger.name(), bytes(capacity), nullptr, GL_DYNAMIC_STORAGE_BIT);
    if (!gl::has_storage(larger, static_cast<std::size_t>(bytes(capacity)))) return gl::Buffer();
    if (buffer) glCopyNamedBufferSubData(buffer.name(), larger.name(), 0, 0, bytes(used_));
    return larger;
  };
  gl::Buffer vertices = enlarged(vertices_, sizeof(PatchVertex));
  gl::Buffer offsets = heights_ ? enlarged(height_offsets_, sizeof(glm::vec2)) : gl::Buffer();
  if (!vertices || (heights_ && !offsets)) return false;
  vertices_ = std::move(vertices);
  height_offsets_ = std::move(offsets);
  points_.resize(static_cast<std::size_t>(capacity) * static_cast<std::size_t>(vertices_per_patch_));
  capacity_ = capacity;
  return true;
}

int PatchBuffers::free_place(std::uint64_t frame) {
  if (used_ < capacity_) return used_++;
  const bool is_full = by_age_.empty() || by_age_.back().last_drawn + views_ > frame;
  if ((is_full || capacity_ < kKept) && grow()) return used_++;
  if (is_full) refused_in_ = frame;
  if (by_age_.empty()) return -1;
  const Place oldest = by_age_.back();
  places_.erase(oldest.mesh);
  by_age_.pop_back();
  return oldest.place;
}

void PatchBuffers::fill(const PatchTree& tree, const PatchNode& node, int place) {
  const std::vector<PatchVertex> vertices = patch_vertices(tree, node);
  const auto bytes = static_cast<GLsizeiptr>(vertices.size() * sizeof(PatchVertex));
  glNamedBufferSubData(vertices_.name(), place * bytes, bytes, vertices.data());
  const glm::dvec3 axes_m = semi_axes_m(tree.ellipsoid());
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    points_[static_cast<std::size_t>(place) * vertices.size() + k] = glm::dvec3(vertices[k].position_high_m) / axes_m;
  }
  if (!heights_) return;
  const std::vector<glm::vec2> offsets = height_offsets_deg(*heights_, tree, node);
  const auto offset_bytes = static_cast<GLsizeiptr>(offsets.size() * sizeof(glm::vec2));
  glNamedBufferSubData(height_offsets_.name(), place * offset_bytes, offset_bytes, offsets.data());
}

int PatchBuffers::place_of(const PatchTree& tree, const PatchNode& node, std::uint64_t frame) {
  const Mesh mesh{node.id, node.relief.made};
  if (const auto found = places_.find(mesh); found != places_.end()) {
    by_age_.splice(by_age_.begin(), by_age_, found->second);
    found->second->last_drawn = frame;
    return found->second->place;
  }
  const int place = free_place(frame);
  if (place < 0) return 0;
  fill(tree, node, place);
  by_age_.push_front({mesh, place, frame});
  places_[mesh] = by_age_.begin();
  return place;
}

}  // namespace terrella
