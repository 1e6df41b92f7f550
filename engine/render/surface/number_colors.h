#pragma once

#include <epoxy/gl.h>

#include <glm/vec4.hpp>
#include <optional>

#include "render/gl/gl_handle.h"
#include "tiles/number_texels.h"
#include "view/number_look.h"

namespace terrella {

/// Texels of a layer; each kind has programs of its own.
enum class TexelKind {
  pictures,
  numbers,
  directions  ///< numbers with a period (NumberInfo::period), whose means go round
};

/// The colours of a layer of numbers, for programs built with NUMBERS (shaders/surface/patch_taps.glsl): a texture of
/// kBakedColors texels, and uniforms that take a texel to its place in this texture. thread: main (of the context)
class NumberColors {
 public:
  static constexpr GLuint kUnit = 4;         ///< the texture unit that the shaders read
  static constexpr GLint kUniformPlace = 0;  ///< location of the uniform `number_look`
  static constexpr GLint kLinesPlace = 24;   ///< location of the uniform `number_lines`

  /// `slots`: how texels store the numbers of `info`.
  NumberColors(const NumberInfo& info, const NumberSlots& slots) : info_(info), slots_(slots) {}

  /// Takes a look over, if it is another. Uploads the texture. Needs the context.
  void set(const NumberLook& look);
  void bind(GLuint unit = kUnit) const;  ///< the texture; after set()
  [[nodiscard]] const glm::vec4& uniform() const { return uniform_; }
  [[nodiscard]] const glm::vec4& lines() const { return lines_; }  ///< value of the uniform `number_lines`
  [[nodiscard]] const NumberInfo& info() const { return info_; }

 private:
  NumberInfo info_;
  NumberSlots slots_;
  std::optional<NumberLook> look_;
  gl::Texture texture_;
  glm::vec4 uniform_{0.0F}, lines_{0.0F};
};

/// Null: a layer of pictures. thread: any
[[nodiscard]] inline TexelKind kind_of(const NumberColors* numbers) {
  if (numbers == nullptr) return TexelKind::pictures;
  return numbers->info().period > 0.0 ? TexelKind::directions : TexelKind::numbers;
}

}  // namespace terrella
