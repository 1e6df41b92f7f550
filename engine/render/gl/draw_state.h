#pragma once

#include <epoxy/gl.h>

#include <optional>

namespace terrella {

/// Blending of a draw's colours with the picture's. The constant colour is black with `constant_alpha`.
struct BlendState {
  GLenum from_rgb = GL_ONE, to_rgb = GL_ZERO, from_alpha = GL_ONE, to_alpha = GL_ZERO;
  GLenum equation = GL_FUNC_ADD;
  float constant_alpha = 0.0F;
  bool operator==(const BlendState&) const = default;
};

struct DepthState {
  GLenum test = GL_LESS;
  bool write = true;
  bool operator==(const DepthState&) const = default;
};

/// A draw passes where the stencil equals `reference` in the bits of `read_mask`, and writes `reference` to the bits of
/// `write_mask`.
struct StencilState {
  GLuint reference = 0, read_mask = 0, write_mask = 0;
  bool operator==(const StencilState&) const = default;
};

struct ColorMask {
  bool red = true, green = true, blue = true, alpha = true;
  bool operator==(const ColorMask&) const = default;
};

/// The OpenGL state that differs between passes. A default value draws with no test, writes everything and blends
/// nothing.
struct DrawState {
  GLuint program = 0;
  std::optional<DepthState> depth = {};      ///< none: neither tests nor writes depth
  std::optional<double> flat_depth = {};     ///< depth of every fragment; none: its own
  std::optional<StencilState> stencil = {};  ///< none: no test; clears write all bits
  std::optional<BlendState> blend = {};
  ColorMask color = {};
  std::optional<GLenum> cull = {};  ///< GL_BACK or GL_FRONT; none: draws both faces
  bool scissor = false;
  bool program_point_size = false;
  bool operator==(const DrawState&) const = default;

  /// The same state with another program.
  [[nodiscard]] DrawState with(GLuint name) const {
    DrawState state = *this;
    state.program = name;
    return state;
  }
};

/// Sets every value of `state`. The state before does not matter. thread: main (of the context)
void apply(const DrawState& state);

}  // namespace terrella
