#include "render/objects/layer_buffers.h"

#include "render/gl/storage.h"

namespace terrella {
namespace {

template <class T>
bool follow_all(LayerBuffers::Buckets& buffers, SlotBatch<T>& batch) {
  bool has_memory = true;
  for (std::size_t k = 0; k < buffers.size(); ++k) {
    has_memory = buffers[k].follow(batch.bucket(k).items, batch.bucket(k).changed) && has_memory;
  }
  return has_memory;
}

}  // namespace

bool FollowingBuffer::fill(const void* data, std::size_t bytes) {
  if (!buffer_) buffer_ = gl::make_buffer();
  const bool grows = capacity_ > 0;
  capacity_ = grows ? bytes + bytes / 2 : bytes;
  glNamedBufferData(buffer_.name(), static_cast<GLsizeiptr>(capacity_), grows ? nullptr : data, GL_DYNAMIC_DRAW);
  if (!gl::has_storage(buffer_, capacity_)) {
    capacity_ = 0;
    return false;
  }
  if (grows) put(0, data, bytes);
  return true;
}

void FollowingBuffer::put(std::size_t at, const void* data, std::size_t bytes) const {
  glNamedBufferSubData(buffer_.name(), static_cast<GLintptr>(at), static_cast<GLsizeiptr>(bytes), data);
}

bool LayerBuffers::follow(LayerObjects& objects) {
  objects.tidy();
  LayerBatches& batches = objects.batches();
  bool has_memory = spheres.follow(batches.spheres.groups.items(), batches.spheres.changed) &&
                    follow_all(markers, batches.markers) && follow_all(icons, batches.icons) &&
                    icon_atlas.follow(batches.icon_images) && follow_all(casings, batches.casings) &&
                    follow_all(lines, batches.lines) && follow_all(fill_vertices, batches.fill_vertices) &&
                    follow_all(fill_indices, batches.fill_indices) && follow_all(solids, batches.solids);
  stands.resize(batches.models.size());
  for (std::size_t k = 0; k < stands.size(); ++k) {
    has_memory = has_memory && follow_all(stands[k], batches.models[k].stands);
  }
  return has_memory;
}

}  // namespace terrella
