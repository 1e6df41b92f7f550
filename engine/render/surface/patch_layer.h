#pragma once

#include <memory>

#include "render/gl/gl_handle.h"
#include "render/surface/patch_buffers.h"

namespace terrella {

/// What the patches of one image layer are drawn from, on the GPU. PatchPass makes and fills it, once a frame.
/// thread: main
struct PatchLayer {
  /// What draws patches, in that order.
  enum Program { magnified, plain, oblique, polar, paper, kPrograms };

  std::unique_ptr<PatchBuffers> vertices;  ///< none: those of the first layer serve
  gl::Buffer draws, commands, cells;
  gl::Buffer frame_block;  ///< of a further layer
  gl::Texture cells_texture;
  int first_command[kPrograms + 1] = {};
  long triangles = 0;
};

}  // namespace terrella
