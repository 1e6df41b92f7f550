#include "apps/bench/truth/judge.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>

#include "apps/bench/truth/masked_error.h"
#include "apps/bench/truth/tile_border_mask.h"

namespace terrella::truth {
namespace {

constexpr double kPoleBand_deg = 81.0;
constexpr double kGrazing_deg = 81.0;
constexpr double kFacing_deg = 12.0;
constexpr double kMidLatitude_deg = 60.0;
constexpr double kAntimeridian_deg = 2.0;
constexpr double kAntimeridianSurroundings_deg = 6.0;
constexpr double kOpenIncidence_deg = 55.0;
constexpr int kLimbReach_px = 2;
constexpr int kBorderGap_px = 1;
constexpr int kBorderSurroundings_px = 12;

struct Spot {
  double abs_lat_deg;
  double to_antimeridian_deg;
  double incidence_deg;
  bool at_border;
  bool near_border;
  bool in_core;
};

// True away from the limb, where few pixels make most of the error.
bool is_open(const Spot& s) { return s.incidence_deg < kOpenIncidence_deg; }

// True where tile borders are far apart. Near the limb and the pole they crowd together and would be compared with
// surroundings elsewhere.
bool border_is_open(const Spot& s) { return is_open(s) && s.abs_lat_deg < kPoleBand_deg; }

bool contains(Zone zone, const Spot& s) {
  switch (zone) {
    case Zone::all:
      return true;
    case Zone::antimeridian:
      return s.to_antimeridian_deg <= kAntimeridian_deg && is_open(s);
    case Zone::antimeridian_surroundings:
      return s.to_antimeridian_deg > kAntimeridian_deg && s.to_antimeridian_deg <= kAntimeridianSurroundings_deg &&
             is_open(s);
    case Zone::pole:
      return s.abs_lat_deg > kPoleBand_deg;
    case Zone::pole_clear:
      return s.abs_lat_deg > kPoleBand_deg && s.incidence_deg < kGrazing_deg;
    case Zone::pole_core:
      return s.in_core;
    case Zone::clear:
      return s.incidence_deg < kGrazing_deg;
    case Zone::facing:
      return s.incidence_deg < kFacing_deg;
    case Zone::mid_latitudes:
      return s.abs_lat_deg < kMidLatitude_deg;
    case Zone::tile_borders:
      return s.at_border && border_is_open(s);
    case Zone::border_surroundings:
      return s.near_border && border_is_open(s);
  }
  return false;
}

struct PixelError {
  double squares = 0.0;
  double max = 0.0;
  double sum = 0.0;  // signed
};

PixelError pixel_error(const Picture& shot, const TruthImage& truth, std::size_t at) {
  PixelError error;
  for (std::size_t c = 3 * at; c < 3 * at + 3; ++c) {
    const double off = static_cast<double>(shot.rgb[c]) - static_cast<double>(truth.rgb[c]);
    error.squares += off * off;
    error.max = std::max(error.max, std::abs(off));
    error.sum += off;
  }
  return error;
}

// Cells of 10° of incidence by 10° of latitude; a renderer's error varies little within a cell.
constexpr double kCell_deg = 10.0;
constexpr std::size_t kCells = 100;
std::size_t cell_of(const Spot& s) {
  return 10 * static_cast<std::size_t>(std::min(9.0, s.incidence_deg / kCell_deg)) +
         static_cast<std::size_t>(std::min(9.0, s.abs_lat_deg / kCell_deg));
}

struct ZoneSums {
  std::array<double, kCells> squares{};
  std::array<std::size_t, kCells> pixels{};
  double max = 0.0;
  double signed_sum = 0.0;

  void add(const PixelError& error, std::size_t cell) {
    squares[cell] += error.squares;
    ++pixels[cell];
    max = std::max(max, error.max);
    signed_sum += error.sum;
  }
  [[nodiscard]] ZoneError error() const {
    const std::size_t count = std::accumulate(pixels.begin(), pixels.end(), std::size_t{0});
    if (count == 0) return {};
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    const double levels = 3.0 * static_cast<double>(count);
    return {std::sqrt(sum / levels), max, count, signed_sum / levels};
  }
  // RMS of these errors, weighted by the other zone's pixels per cell.
  [[nodiscard]] double rms_weighted_like(const ZoneSums& other) const {
    double sum = 0.0;
    double weight = 0.0;
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      if (pixels[cell] == 0) continue;
      const auto share = static_cast<double>(other.pixels[cell]);
      sum += share * squares[cell] / (3.0 * static_cast<double>(pixels[cell]));
      weight += share;
    }
    return weight > 0.0 ? std::sqrt(sum / weight) : error().rms;
  }
};

void count(LimbError& limb, const PixelError& error) {
  ++limb.pixels;
  limb.off += error.max > kLimbOff_levels;
}

Mask partly_covered(const TruthImage& truth) {
  Mask mask{truth.width, truth.height, std::vector<std::uint8_t>(truth.hits.size())};
  for (std::size_t i = 0; i < truth.hits.size(); ++i) mask.set[i] = truth.hits[i] > 0 && !truth.covered(i);
  return mask;
}

struct SpotMasks {
  Mask border;
  Mask surroundings;
  Mask core;
};

SpotMasks spot_masks(const TruthImage& truth, const Spheroid& body, const RowRule& rows,
                     const std::optional<TileBorders>& borders) {
  const Mask none{truth.width, truth.height, std::vector<std::uint8_t>(truth.hits.size())};
  if (!borders) return {none, none, pole_core_mask(truth)};
  SpotMasks masks{tile_border_mask(truth, body, rows, *borders), none, pole_core_mask(truth)};
  const Mask close = grown(masks.border, kBorderGap_px);
  masks.surroundings = grown(masks.border, kBorderSurroundings_px);
  for (std::size_t i = 0; i < close.set.size(); ++i)
    masks.surroundings.set[i] &= static_cast<std::uint8_t>(!close.set[i]);
  return masks;
}

Spot spot_of(const TruthImage& truth, const SpotMasks& masks, std::size_t at) {
  return {std::abs(static_cast<double>(truth.lat_deg[at])),
          180.0 - std::abs(static_cast<double>(truth.lon_deg[at])),
          static_cast<double>(truth.incidence_deg[at]),
          masks.border.set[at] != 0,
          masks.surroundings.set[at] != 0,
          masks.core.set[at] != 0};
}

}  // namespace

std::string_view zone_name(Zone zone) {
  constexpr std::array<std::string_view, kZones> kNames{"all",
                                                        "antimeridian",
                                                        "antimeridian surroundings",
                                                        "pole",
                                                        "pole clear",
                                                        "pole core",
                                                        "clear",
                                                        "facing",
                                                        "mid latitudes",
                                                        "tile borders",
                                                        "border surroundings"};
  return kNames[static_cast<std::size_t>(zone)];
}

Judgement judge(const Picture& shot, const TruthImage& truth, const Spheroid& body, const RowRule& rows,
                const std::optional<TileBorders>& borders) {
  if (shot.width != truth.width || shot.height != truth.height) {
    throw std::invalid_argument("the picture is " + std::to_string(shot.width) + "x" + std::to_string(shot.height) +
                                ", the truth " + std::to_string(truth.width) + "x" + std::to_string(truth.height));
  }
  const SpotMasks masks = spot_masks(truth, body, rows, borders);
  const Mask limb = grown(partly_covered(truth), kLimbReach_px);
  Judgement result{};
  std::array<ZoneSums, kZones> sums{};
  for (std::size_t at = 0; at < truth.hits.size(); ++at) {
    const PixelError error = pixel_error(shot, truth, at);
    if (!truth.covered(at)) {
      count(result.outside, error);
      if (limb.set[at]) count(result.limb, error);
      continue;
    }
    const Spot spot = spot_of(truth, masks, at);
    for (std::size_t z = 0; z < kZones; ++z) {
      if (contains(static_cast<Zone>(z), spot)) sums[z].add(error, cell_of(spot));
    }
  }
  for (std::size_t z = 0; z < kZones; ++z) result.zones[z] = sums[z].error();
  const auto weigh = [&](Zone beside, Zone zone) {
    const auto b = static_cast<std::size_t>(beside);
    result.zones[b].rms = sums[b].rms_weighted_like(sums[static_cast<std::size_t>(zone)]);
  };
  weigh(Zone::antimeridian_surroundings, Zone::antimeridian);
  weigh(Zone::border_surroundings, Zone::tile_borders);
  return result;
}

}  // namespace terrella::truth
