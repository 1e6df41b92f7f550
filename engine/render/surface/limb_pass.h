#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/frame_targets.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// The finished picture without antialiasing of the limb, and the part of it that belongs to the view.
struct LimbPicture {
  GLuint texture = 0;
  /// Left column of the view's part. The part is as large as the view and starts at the texture's lowest row.
  int left_px = 0;
  /// 2: only every other row belongs to this view; 0: the picture already contains the limb.
  int rows_apart = 1;
};

/// Antialiases the globe's limb in a finished picture; shaders/surface/limb.frag. thread: main
class LimbPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<LimbPass>> create();

  /// Blends the limb into the bound framebuffer, without a depth test. Returns the number of draw calls: 0 if no limb
  /// is in view, else 1.
  int draw(const View& view, const Ellipsoid& ellipsoid, const LimbPicture& picture);
  /// The same if the bound framebuffer contains the picture itself. Draws by way of a second picture of the same size,
  /// because a texture must not be read and written at once. Returns 0 or 2.
  int draw_in_place(const View& view, const Ellipsoid& ellipsoid, const LimbPicture& picture,
                    const FrameTargets::Beside& beside, GLuint framebuffer);

 private:
  LimbPass() = default;
  [[nodiscard]] GLsizei upload(const View& view, const Ellipsoid& ellipsoid) const;
  void draw_ribbon(GLsizei vertices, const View& view, const LimbPicture& picture) const;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
};

}  // namespace terrella
