#pragma once

#include <span>
#include <string_view>

namespace terrella {

/// A GLSL file of this folder, with its text when the library was built.
struct EmbeddedShader {
  std::string_view name;
  std::string_view text;
};
[[nodiscard]] std::span<const EmbeddedShader> embedded_shaders();

}  // namespace terrella
