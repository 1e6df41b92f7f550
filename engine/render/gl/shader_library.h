#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "render/gl/gl_handle.h"
#include "view/render_modes.h"

namespace terrella {

/// One stage of a program: files of shaders/, concatenated. An entry with a line break is text in place of a file.
struct ShaderStage {
  GLenum type;
  std::vector<std::string_view> files;
};

/// Reads shaders from a folder, and those in it, instead of the embedded ones; empty: the embedded ones. Programs that
/// are built already stay. In builds with assertions, the environment variable TERRELLA_SHADER_DIR names the folder
/// while none is set. thread: main
void read_shaders_from(std::filesystem::path folder);

/// Returns the text of a file of shaders/; nothing if there is none of that name. thread: any
[[nodiscard]] std::optional<std::string> shader_text(std::string_view name);

/// Compiles and links a program from the files of shader_text(). `defines` become #defines before the text.
/// `feedback` lists the outputs of the vertex stage that transform feedback records, in order. For debuggers, the
/// program is labelled with the last file of its last stage. The error names the file and contains the compiler's
/// message. thread: main
[[nodiscard]] Result<gl::Program> build_program(std::initializer_list<ShaderStage> stages,
                                                std::initializer_list<std::string_view> defines,
                                                std::initializer_list<const char*> feedback = {});

/// Builds a program into `place`. Fails as build_program() does. thread: main
Status build_into(gl::Program& place, std::initializer_list<ShaderStage> stages,
                  std::initializer_list<std::string_view> defines);

/// Returns the #define that tells shaders how depth is stored. thread: any
[[nodiscard]] std::string_view depth_define(DepthMode mode);

}  // namespace terrella
