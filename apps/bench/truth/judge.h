#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "apps/bench/truth/ray_caster.h"

namespace terrella::truth {

/// Parts of the picture that are judged apart. Pixels that the body covers only in part belong to none of them but
/// to the limb (below). Angles are those of the pixel's centre.
enum class Zone {
  all,                        ///< every covered pixel
  antimeridian,               ///< within 2° of ±180°
  antimeridian_surroundings,  ///< 2° to 6° from ±180°
  pole,                       ///< latitude over 81°, north or south
  pole_clear,                 ///< the same with incidence under 81°
  clear,                      ///< incidence under 81°
  facing,               ///< incidence under 12°: from four radii, what the pole band is when seen from over the pole
  mid_latitudes,        ///< latitude under 60°
  tile_borders,         ///< within a pixel of a border between tiles; incidence under 55°, outside the pole bands
  border_surroundings,  ///< 2 to 12 pixels from a tile border, likewise
};
inline constexpr std::size_t kZones = 10;
[[nodiscard]] std::string_view zone_name(Zone zone);

/// The two surroundings are weighed: their errors count, by cells of 10° of incidence and of latitude, as often as the
/// zone that they surround has pixels there, so that like is compared with like.

/// The grid whose tile borders are looked at: origin (-180°, 90°), tiles of root_span / 2^level degrees.
struct TileBorders {
  double root_span_deg = 180.0;
  int level = 0;
};

struct ZoneError {
  double rms = 0.0;        ///< over the three channels, 8-bit levels
  double max = 0.0;        ///< of one channel of one pixel
  std::size_t pixels = 0;  ///< 0: the zone is not in the picture, and the errors are 0
  double bias = 0.0;       ///< mean of shot minus truth: what rounding down instead of to nearest would show, for one
};

/// Pixels off by over 40 levels in a channel.
struct LimbError {
  std::size_t pixels = 0;
  std::size_t off = 0;
  [[nodiscard]] double share() const {
    return pixels == 0 ? 0.0 : static_cast<double>(off) / static_cast<double>(pixels);
  }
};
inline constexpr double kLimbOff_levels = 40.0;

struct Judgement {
  std::array<ZoneError, kZones> zones;
  LimbError limb;     ///< pixels covered in part, and those outside within 2 px of them
  LimbError outside;  ///< all pixels that are not covered in full
  [[nodiscard]] const ZoneError& operator[](Zone zone) const { return zones[static_cast<std::size_t>(zone)]; }
};

/// Compares a picture with the truth. Throws std::invalid_argument if their sizes differ. `rows` says in which latitude
/// the tiles are cut. (`mid_latitudes` and the others overlap: a pixel counts in each zone that it is in.)
[[nodiscard]] Judgement judge(const Picture& shot, const TruthImage& truth, const Spheroid& body, const RowRule& rows,
                              const std::optional<TileBorders>& borders);

}  // namespace terrella::truth
