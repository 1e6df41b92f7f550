#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
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

/// Antialiases the globe's limb in a finished picture (shaders/surface/limb.frag). thread: main
class LimbPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<LimbPass>> create();

  /// Blends the limb into the bound framebuffer with the stencil test and color mask of `state`, without a depth test.
  /// Returns the draw calls made: 0 if no limb is in view, else 1.
  int draw(const View& view, const Ellipsoid& ellipsoid, const LimbPicture& picture, const DrawState& state);
  /// The same if the bound framebuffer is the one that holds the picture. Draws into `beside` first, because a pass
  /// must not read the texture that it writes. Returns 0 or 2.
  int draw_in_place(const View& view, const Ellipsoid& ellipsoid, const LimbPicture& picture, const DrawState& state,
                    const FrameTargets::Beside& beside, GLuint framebuffer);

 private:
  LimbPass() = default;
  [[nodiscard]] GLsizei upload(const View& view, const Ellipsoid& ellipsoid) const;
  void draw_ribbon(GLsizei vertices, const View& view, const LimbPicture& picture, DrawState state) const;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
};

}  // namespace terrella
