#pragma once

#include <epoxy/gl.h>

#include "base/result.h"
#include "render/gl/gl_handle.h"
#include "sky/cube_picture.h"

namespace terrella {

/// The lights of cities as a cube map, for programs built with NIGHT_LIGHTS (shaders/surface/patch_common.glsl). 2 MB
/// on the GPU for a map 2048 pixels wide. thread: main (of the context)
class NightLights {
 public:
  static constexpr GLuint kUnit = 6;  ///< the texture unit that the shaders look at

  /// Fails if the map is empty, its values do not fill it, or it is too large.
  [[nodiscard]] static Result<NightLights> create(const GreyPicture& map);

  /// Binds texture and sampling to kUnit, and turns on filtering across the faces' borders.
  void bind() const;

 private:
  explicit NightLights(gl::Texture texture) : texture_(std::move(texture)) {}
  gl::Texture texture_;
};

}  // namespace terrella
