#pragma once

#include <cfloat>
#include <cstddef>

#include "tiles/tile_source.h"
#include "tiles/tile_texels.h"

// thread: any, for all of this header
namespace terrella {

/// A float texel that has no data. NaN would not be safe: shaders may take it for a number.
inline constexpr float kNoNumber = -FLT_MAX;

/// Storage of a set's numbers in texels: as codes of 16 bits, number = least + code / steps, or as 32-bit floats.
struct NumberSlots {
  bool codes = false;
  double least = 0.0;  ///< number of code 0
  double steps = 1.0;  ///< codes per 1, whole; above 1 for short ranges, so that means keep fractions
  int none = 0;        ///< code of a texel without data
  bool operator==(const NumberSlots&) const = default;
};

/// Chooses codes if the numbers are whole and leave a code free for "no data" (NumberInfo::whole), else floats.
[[nodiscard]] NumberSlots number_slots(const NumberInfo& info);
[[nodiscard]] constexpr std::size_t texel_bytes(const NumberSlots& slots) { return slots.codes ? 2 : 4; }
/// The number of a texel; NaN if it has no data. `texel`: a code or a float.
[[nodiscard]] double number_of(const NumberSlots& slots, double texel);

/// Decodes a tile of numbers to texels, one number each, with the mips and the gutter of make_texels(). A mip's texel
/// is the mean of those numbers under it that have data. It has no data if less than half of them have data. Fails as
/// decode_numbers() does. thread: worker
[[nodiscard]] Result<TileTexels, TileFailure> make_number_texels(const EncodedTile& tile, const NumberInfo& info,
                                                                 int tile_px, int gutter, int mips);

}  // namespace terrella
