#pragma once

#include <vector>

#include "render/gl/gl_handle.h"
#include "render/surface/number_colors.h"

namespace terrella {

/// The record that glMultiDrawElementsIndirect reads.
struct DrawCommand {
  GLuint count;
  GLuint instances;
  GLuint first_index;
  GLint base_vertex;
  GLuint base_instance;
};

/// Replaces the contents of a buffer that changes with each frame.
template <class T>
void stream(const gl::Buffer& buffer, const std::vector<T>& data) {
  glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

/// The GPU data from which the patches of one image layer in one view are drawn. PatchPass makes it, and fills it once
/// per frame. thread: main
struct PatchLayer {
  /// The programs that draw patches, in the order of drawing, and those that draw a patch's triangles at the limb.
  enum Program { magnified, plain, seven_taps, oblique, polar_short, polar, polar_long, paper, kPrograms };
  enum LimbProgram { limb = kPrograms, polar_limb, kAll };
  /// Each program with and without city lights: 2 * program, + 1 by night. Those of the limb come last.
  static constexpr int kVariants = 2 * kAll, kWholeVariants = 2 * kPrograms;

  const NumberColors* numbers = nullptr;  ///< null: a layer of pictures
  gl::Buffer draws, commands, cells;
  gl::Buffer limb_indices;  ///< triangles at the limb; the shared indices have those of whole patches
  gl::Buffer frame_block;   ///< used for upper layers
  gl::Texture cells_texture;
  gl::Buffer slope_draws, slope_cells;  ///< made by SlopeTextures; only with relief
  gl::Texture slope_cells_texture;
  int first_command[kVariants + 1] = {};
  long triangles = 0;
};

}  // namespace terrella
