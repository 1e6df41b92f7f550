#pragma once

#include <string_view>

#include "base/result.h"

namespace terrella {

/// Whose functions of angles shaders use (shaders/functions.glsl).
enum class ShaderFunctions { driver, own };

/// The worst that a GPU's functions are off, against double, over the arguments that the shaders give them. Those of
/// angles and roots are relative: a texel's place is a multiple of them.
struct FunctionErrors {
  double atan = 0.0;         ///< of any quadrant, angles from 1e-7 rad on; relative
  double asin = 0.0;         ///< [-1, 1]; rad
  double sine = 0.0;         ///< of angles to half a turn either way
  double cosine = 0.0;       ///< the same
  double inversesqrt = 0.0;  ///< of 1e-12 to 4; relative
  double length = 0.0;       ///< of two parts, 1e-7 to 2 long; relative
};

/// What the engine puts up with. A patch's window is up to 32 tiles of 256 texels wide (PatchSelectionOptions), so from
/// its middle an angle that is off by so large a part moves a texel by 2^12 · 2^-18 = 1/64 of itself.
inline constexpr double kMostFunctionError = 0x1p-18;

/// Whether all that the place of a texel hangs on keeps kMostFunctionError; asin is not among it.
[[nodiscard]] bool good_enough(const FunctionErrors& errors);

/// Draws one row of arguments and reads it back. thread: main (of the context). The GL state is changed.
[[nodiscard]] Result<FunctionErrors> measure_shader_functions(ShaderFunctions functions);

/// The driver's if they are good enough, else the engine's own. thread: main (of the context)
[[nodiscard]] Result<ShaderFunctions> choose_shader_functions();

/// The name by which shaders know whose functions to use. thread: any
[[nodiscard]] std::string_view functions_define(ShaderFunctions functions);

}  // namespace terrella
