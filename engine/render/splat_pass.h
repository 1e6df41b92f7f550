#pragma once

#include <cstddef>

#include "geo/result.h"
#include "render/frame_block.h"
#include "render/gl_handle.h"
#include "render/mapped_buffer.h"
#include "render/stream_buffer.h"
#include "scene/render_modes.h"
#include "scene/sphere_splats.h"

namespace terrella {

/// Draws many small opaque spheres on software GL: in memory first (scene/sphere_splats.h), then as blocks of a picture
/// with depth. thread: main
class SplatPass {
 public:
  [[nodiscard]] Status create(DepthMode depth);
  void set_spheres(const Batch<DotInstance>& spheres) { spheres_ = SphereGroups(spheres); }

  /// Makes the picture of a range of the spheres; what is too wide for it is for the caller to draw first, so that what
  /// that hides is not seen at its edges. False if there is no room for such a picture: nothing is to be drawn then.
  [[nodiscard]] bool prepare(std::size_t first, std::size_t count, const FrameBlock& frame, Viewport viewport,
                             double hiding_radius_m);
  [[nodiscard]] int large_count() const { return static_cast<int>(splats_.large().size()); }
  [[nodiscard]] GLuint large_buffer() const { return large_.name(); }
  /// State as for ObjectPass::draw(). Returns the draw calls made: one, or none if nothing is to be seen.
  int draw(Viewport viewport);

 private:
  SphereGroups spheres_;
  SphereSplats splats_;
  gl::Program program_;
  gl::VertexArray array_;
  StreamBuffer runs_, large_;
  MappedBuffer picture_;
  gl::Texture pixel_texture_;
  std::size_t most_blocks_ = 0;
};

}  // namespace terrella
