#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/result.h"
#include "view/color_map.h"

namespace terrella {

/// Colours of a layer of numbers: a stretch and a colour map. A change loads and uploads no tile. Values are in the
/// unit of the numbers (NumberInfo), after scale and offset.
struct NumberLook {
  double low = 0.0;   ///< value at the map's position 0; values below it have the colour of `low`
  double high = 1.0;  ///< value at position 1, above `low`; values above it have the colour of `high`
  /// Value at position 0.5, for maps with a middle: both halves are stretched by themselves. If it lies outside
  /// [low, high], only the half of the map on the stretch's side is used. None: the middle of low and high.
  std::optional<double> center = {};
  ColorMap colors = {.stops = {{0.0, {0, 0, 0}}, {1.0, {255, 255, 255}}}};
  /// The Sun, the relief and the air change the colours, as those of a picture. False: each pixel has the colour that
  /// the map gives its value, by night and at the limb too.
  bool lit = false;
  /// Contour lines at the multiples of this step, one pixel wide, every fifth two; 0: none. As low and high: in the
  /// unit of the values. Lines less than four pixels apart fade.
  double contour_step = 0.0;
  bool operator==(const NumberLook&) const = default;
};

/// Number of colours in a look's texture: texel k is the colour of low + (high - low) · (k + 0.5) / kBakedColors.
inline constexpr int kBakedColors = 1024;

/// Fails if low and high are not finite with low < high, if the map has no stops or stops out of order, or if the step
/// of contour lines is below 0 or not finite. The error says what is wrong. thread: any
[[nodiscard]] Status check_look(const NumberLook& look);
/// The colour of a value, not rounded to a texel of bake(). `look` has passed check_look(). thread: any
[[nodiscard]] Rgba8 color_of(const NumberLook& look, double value);
/// The texture of a look: kBakedColors RGBA texels, premultiplied by alpha. thread: any
[[nodiscard]] std::vector<std::uint8_t> bake(const NumberLook& look);

}  // namespace terrella
