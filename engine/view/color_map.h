#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace terrella {

/// A colour: sRGB as stored, alpha not premultiplied.
struct Rgba8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  bool operator==(const Rgba8&) const = default;
};

/// A colour at a place of a colour map.
struct ColorStop {
  double at = 0.0;  ///< a position in [0, 1], or a value (ColorMap::by_value)
  Rgba8 color;
  bool operator==(const ColorStop&) const = default;
};

/// Colours of numbers. Between stops, colours are interpolated in sRGB. Before the first stop the first colour holds,
/// after the last stop the last one. Two stops at the same place make a step.
struct ColorMap {
  std::vector<ColorStop> stops;  ///< at least one, `at` ascending, finite
  bool by_value = false;         ///< stops are values in the unit of the numbers; false: positions within a stretch
  bool discrete = false;         ///< a colour holds from its stop up to the next; false: interpolated
  bool operator==(const ColorMap&) const = default;
};

/// Names of the engine's own maps: viridis, magma, cividis, grey, terrain, diverging. thread: any
[[nodiscard]] std::span<const std::string_view> color_map_names();
/// One of the engine's maps, or `aspect`, whose ends are the same; none if the name is unknown. `terrain` and
/// `diverging` have their middle at position 0.5: the shore and the neutral grey (NumberLook::center). They are free to
/// use. thread: any
[[nodiscard]] std::optional<ColorMap> named_color_map(std::string_view name);
/// The colour of a map at a position or, for a map by value, at a value; black for a map without stops. thread: any
[[nodiscard]] Rgba8 color_at(const ColorMap& map, double at);

}  // namespace terrella
