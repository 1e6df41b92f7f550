#pragma once

#include "apps/bench/truth/judge.h"
#include "apps/bench/truth/tile_border_mask.h"

namespace terrella::truth {

/// Where the paper's pole bands are well in view: covered in full, latitude over 81° north or south, incidence under
/// 81°.
[[nodiscard]] Mask pole_band_mask(const TruthImage& truth);
/// Covered in full, latitude under 60°, incidence under 81°.
[[nodiscard]] Mask mid_latitude_mask(const TruthImage& truth);

/// Covered in full, incidence under 81°.
[[nodiscard]] Mask clear_mask(const TruthImage& truth);

/// The error over the pixels that a mask has and that the body covers in full. The three must be of one size.
[[nodiscard]] ZoneError masked_error(const Picture& shot, const TruthImage& truth, const Mask& mask);

}  // namespace terrella::truth
