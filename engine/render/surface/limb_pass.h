#pragma once

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
#include "render/gl/gl_handle.h"
#include "render/sky/air_textures.h"

namespace terrella {

/// The finished picture without antialiasing of the limb, and the part of it that belongs to the view.
struct LimbPicture {
  GLuint texture = 0;
  /// Left column of the view's part. The part is as large as the view and starts at the texture's lowest row.
  int left_px = 0;
  /// 2: only every other row belongs to this view; 0: the picture already contains the limb.
  int rows_apart = 1;
  bool from_samples = false;  ///< a pixel of the picture is the mean over its square, not the colour at its centre
};

/// The content of the ground's colours at the limb.
enum class LimbLook {
  imagery,  ///< imagery alone: shaders/surface/limb.frag
  lit,      ///< light: shaders/surface/limb_air.frag
  whole,    ///< light, and each pixel's own ground: shaders/surface/limb_whole.frag
  in_air    ///< light, and air that may be thinner than a pixel: the same with AIR
};

/// Antialiases the globe's limb in a finished picture. thread: main
class LimbPass {
 public:
  LimbPass();

  /// Builds the program of a look unless it exists.
  Status prepare(LimbLook look, bool from_samples);
  /// Fits the ribbon to the limb of a view. False if no limb is in view.
  bool fit(const View& view, const Ellipsoid& ellipsoid);
  /// Blends the limb into the bound framebuffer with the stencil test and color mask of `state`, without a depth test.
  /// prepare() has built the program of `look`. `air` is used by `in_air` alone.
  void draw(const View& view, const LimbPicture& picture, LimbLook look, const AirTextures* air, DrawState state) const;

 private:
  gl::Program programs_[2][4];  ///< by LimbPicture::from_samples and LimbLook
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
  GLsizei count_ = 0;
};

}  // namespace terrella
