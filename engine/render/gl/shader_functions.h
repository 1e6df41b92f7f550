#pragma once

#include <string_view>

#include "base/result.h"

namespace terrella {

/// The implementation of angle functions in shaders (shaders/functions.glsl): the driver's or the engine's own.
enum class ShaderFunctions { driver, own };

/// Largest errors of a GPU's functions compared with double, over the arguments that the shaders use. Errors of angles
/// and roots are relative, because a texel's position is a multiple of them.
struct FunctionErrors {
  double atan = 0.0;         ///< any quadrant, angles from 1e-7 rad on; relative
  double asin = 0.0;         ///< [-1, 1]; rad
  double sine = 0.0;         ///< angles up to half a turn either way
  double cosine = 0.0;       ///< angles up to half a turn either way
  double inversesqrt = 0.0;  ///< arguments from 1e-12 to 4; relative
  double length = 0.0;       ///< vectors of two components, length 1e-7 to 2; relative
};

/// Largest error that the engine accepts. A patch's window is up to 32 tiles of 256 texels wide
/// (PatchSelectionOptions). At its border, 2^12 texels from its middle, an angle with this relative error moves a texel
/// by 2^12 · 2^-18 = 1/64 of its width.
inline constexpr double kMostFunctionError = 0x1p-18;

/// True if all functions that determine a texel's position are within kMostFunctionError; asin does not.
[[nodiscard]] bool good_enough(const FunctionErrors& errors);

/// Draws one row of arguments and reads the results back. Changes the GL state. thread: main
[[nodiscard]] Result<FunctionErrors> measure_shader_functions(ShaderFunctions functions);

/// Chooses the driver's functions if they are accurate enough, else the engine's own. thread: main
[[nodiscard]] Result<ShaderFunctions> choose_shader_functions();

/// Returns the #define that selects the functions in shaders. thread: any
[[nodiscard]] std::string_view functions_define(ShaderFunctions functions);

}  // namespace terrella
