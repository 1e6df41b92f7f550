#pragma once

#include <epoxy/gl.h>

#include "base/result.h"
#include "render/gl/gl_handle.h"
#include "sky/cube_picture.h"

namespace terrella {

/// City lights as a cube map, for programs built with CITY_LIGHTS (shaders/surface/patch_common.glsl). It takes 2 MB
/// on the GPU for a map 2048 pixels wide. thread: main
class NightLights {
 public:
  static constexpr GLuint kUnit = 6;  ///< the texture unit that the shaders read

  /// Fails if the map is empty, if its number of values does not match its size, or if it is too large.
  [[nodiscard]] static Result<NightLights> create(const GreyPicture& map);

  /// Binds texture and sampler to kUnit, and enables filtering across the borders of the faces.
  void bind() const;

 private:
  explicit NightLights(gl::Texture texture) : texture_(std::move(texture)) {}
  gl::Texture texture_;
};

}  // namespace terrella
