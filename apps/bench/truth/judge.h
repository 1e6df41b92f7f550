#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "apps/bench/truth/ray_caster.h"

namespace terrella::truth {

/// Parts of the picture with separate results. Partly covered pixels belong only to the limb (below). Angles are those
/// of the pixel's centre.
enum class Zone {
  all,                        ///< every covered pixel
  antimeridian,               ///< within 2° of ±180°; incidence under 55°
  antimeridian_surroundings,  ///< 2° to 6° from ±180°, under the same condition
  pole,                       ///< latitude over 81°, north or south
  pole_clear,                 ///< latitude over 81° and incidence under 81°
  pole_core,                  ///< within 40 px of the pole and incidence under 81°
  clear,                      ///< incidence under 81°
  facing,                     ///< incidence under 12°: the pole band as seen from over the pole, from four radii
  mid_latitudes,              ///< latitude under 60°
  tile_borders,               ///< within a pixel of a tile border; incidence under 55°, outside the pole bands
  border_surroundings,        ///< 2 to 12 pixels from a tile border, under the same conditions
};
inline constexpr std::size_t kZones = 11;
[[nodiscard]] std::string_view zone_name(Zone zone);

/// The two surroundings are weighted by cells of 10° of incidence and latitude. Each cell counts as often as the
/// surrounded zone has pixels there, so that the comparison is fair.

/// The grid of the tile borders: origin (-180°, 90°), tiles of root_span / 2^level degrees.
struct TileBorders {
  double root_span_deg = 180.0;
  int level = 0;
};

struct ZoneError {
  double rms = 0.0;        ///< over the three channels, 8-bit levels
  double max = 0.0;        ///< greatest error of one channel of one pixel
  std::size_t pixels = 0;  ///< 0: the zone is not in the picture, and the errors are 0
  double bias = 0.0;       ///< mean of shot minus truth; reveals rounding down instead of to nearest, for example
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
  LimbError limb;     ///< partly covered pixels, and outside pixels within 2 px of them
  LimbError outside;  ///< all pixels that are not fully covered
  [[nodiscard]] const ZoneError& operator[](Zone zone) const { return zones[static_cast<std::size_t>(zone)]; }
};

/// Compares a picture with the truth. Throws std::invalid_argument if their sizes differ. `rows` sets the latitude in
/// which the tiles are cut. Zones overlap; a pixel counts in each of its zones.
[[nodiscard]] Judgement judge(const Picture& shot, const TruthImage& truth, const Spheroid& body, const RowRule& rows,
                              const std::optional<TileBorders>& borders);

}  // namespace terrella::truth
