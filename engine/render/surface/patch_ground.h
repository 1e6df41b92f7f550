#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/gl_handle.h"

namespace terrella {

struct GroundFrame;

/// The GPU data from which the things on the ground are drawn in one view. PatchPass makes it. thread: main
struct PatchGround {
  /// Draw commands with one program.
  struct Batch {
    std::uint32_t look = 0;  ///< GroundFrame::windows, z; 8: the triangles at the limb, which come first
    int from = 0, to = 0;
  };
  std::vector<Batch> batches;
  gl::Buffer windows, cells, commands, limb_indices;
  gl::Texture cells_texture;
};

/// Lines and areas on the ground in a frame, and their data on the GPU.
struct GroundDraw {
  const GroundFrame* frame = nullptr;  ///< null: nothing
  const PatchGround* gpu = nullptr;
};

}  // namespace terrella
