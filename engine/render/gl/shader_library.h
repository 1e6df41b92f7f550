#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "base/result.h"
#include "render/gl/gl_handle.h"
#include "view/render_modes.h"

namespace terrella {

/// One stage of a program: files of shaders/, one after the other.
struct ShaderStage {
  GLenum type;
  std::initializer_list<std::string_view> files;
};

/// Compiles and links a program from the embedded files, or from the folder that the environment variable
/// TERRELLA_SHADER_DIR names, read anew each time. `defines` are names put before the text with #define.
/// The program is labelled with the last file of its last stage, for debuggers. The error names the file and carries
/// the compiler's words. `feedback` are outputs of the vertex stage that transform feedback records, one after the
/// other, if any. thread: main
[[nodiscard]] Result<gl::Program> build_program(std::initializer_list<ShaderStage> stages,
                                                std::initializer_list<std::string_view> defines,
                                                std::initializer_list<const char*> feedback = {});

/// The name by which shaders know how depth is stored. thread: any
[[nodiscard]] std::string_view depth_define(DepthMode mode);

}  // namespace terrella
