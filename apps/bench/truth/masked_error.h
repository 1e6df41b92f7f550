#pragma once

#include "apps/bench/truth/judge.h"
#include "apps/bench/truth/tile_border_mask.h"

namespace terrella::truth {

/// Fully covered pixels with a clear view of the pole bands of Zuev's paper (baseline/paper_sphere.h): latitude over
/// 81° north or south, incidence under 81°.
[[nodiscard]] Mask pole_band_mask(const TruthImage& truth);
/// Fully covered pixels with latitude under 60° and incidence under 81°.
[[nodiscard]] Mask mid_latitude_mask(const TruthImage& truth);

/// Fully covered pixels with incidence under 81°.
[[nodiscard]] Mask clear_mask(const TruthImage& truth);

/// Fully covered pixels within 40 px of the pole: the core, where meridians converge. Empty if the picture contains no
/// pole, or contains it on its outermost row or column or with an incidence over 81°.
[[nodiscard]] Mask pole_core_mask(const TruthImage& truth);

/// The error over fully covered pixels within a mask. Shot, truth and mask must have the same size.
[[nodiscard]] ZoneError masked_error(const Picture& shot, const TruthImage& truth, const Mask& mask);

}  // namespace terrella::truth
