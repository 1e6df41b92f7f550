#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include "apps/bench/stability/check.h"
#include "apps/bench/stability/place_errors.h"

namespace terrella::bench {
namespace {

constexpr Viewport kPlacePicture{256, 256};
constexpr double kMostPlaceOff_px = 0.25;
// Texels here are about as large as pixels.
constexpr double kMostOff_texels = 0.25;

/// Counts shared vertices of patches that have two positions.
int split_vertices(const PatchScene& scene, PatchProbe& probe) {
  using Bits = std::array<std::uint32_t, 6>;
  const std::vector<glm::vec4> clip = probe.positions(scene.view);
  const auto bits_of = [](const PatchVertex& v) {
    const glm::vec3 &h = v.position_high_m, &l = v.position_low_m;
    return Bits{std::bit_cast<std::uint32_t>(h.x), std::bit_cast<std::uint32_t>(h.y),
                std::bit_cast<std::uint32_t>(h.z), std::bit_cast<std::uint32_t>(l.x),
                std::bit_cast<std::uint32_t>(l.y), std::bit_cast<std::uint32_t>(l.z)};
  };
  std::map<Bits, glm::vec4> first;
  int split = 0;
  for (std::size_t k = 0; k < clip.size(); ++k) {
    const auto [found, made] = first.try_emplace(bits_of(scene.vertices[k]), clip[k]);
    if (!made && found->second != clip[k]) ++split;
  }
  return split;
}

Camera straight_down(double lat_deg, double lon_deg, double height_m) {
  return {.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m},
          .heading = Angle::degrees(20.0)};
}

// Height at which texels of this level are about as large as pixels.
double height_for(int level) {
  TileGrid grid;
  const double texel_m = Angle::degrees(tile_span_deg(grid, level)).rad() * earth().ellipsoid.a_m() / grid.tile_px;
  return 0.9 * texel_m * kPlacePicture.height_px / (2.0 * std::tan(Angle::degrees(20.0).rad()));
}

void check_level(int level, PatchProbe& probe, Checks& checks) {
  PlaceErrors errors;
  Check check{.test = "texture coordinates",
              .subject = "interpolated",
              .at = static_cast<double>(level),
              .at_unit = "level",
              .unit = "texels",
              .limit = kMostOff_texels};
  check = timed(check, [&] {
    PatchScene scene(straight_down(47.123, 8.456, height_for(level)), kPlacePicture, level);
    errors = place_errors(scene, probe);
    return errors.interpolated_texels;
  });
  checks.push_back(check);
  check.subject = "exact";
  check.error = errors.exact_texels;
  checks.push_back(check);
}

struct HardPlace {
  const char* name;
  double lat_deg, lon_deg;
};
// A corner of the cube lies where |x| = |y| = |z|.
constexpr HardPlace kHardPlaces[] = {{"antimeridian", -12.0, 180.0},
                                     {"cube edge", 10.0, 45.0},
                                     {"cube corner", 35.264389682754654, 45.0},
                                     {"north pole", 90.0, 0.0},
                                     {"beside the south pole", -89.5, 100.0}};

void check_place(const HardPlace& place, double height_m, PatchProbe& probe, Checks& checks) {
  PlaceErrors errors;
  int split = 0;
  Check check{.test = "place drawn",
              .subject = place.name,
              .at = height_m,
              .at_unit = "m",
              .unit = "px",
              .limit = kMostPlaceOff_px};
  check = timed(check, [&] {
    PatchScene scene(straight_down(place.lat_deg, place.lon_deg, height_m), kPlacePicture, kMaxTileLevel);
    errors = place_errors(scene, probe);
    split = split_vertices(scene, probe);
    return errors.drawn_px;
  });
  checks.push_back(check);
  check.limit = 0.0;
  check.test = "holes";
  check.error = errors.holes;
  check.unit = "pixels";
  checks.push_back(check);
  check.test = "shared vertices apart";
  check.error = split;
  check.unit = "vertices";
  checks.push_back(check);
}

}  // namespace

Status check_places(const StabilityOptions& options, Checks& checks) {
  Result<PatchProbe> probe = PatchProbe::create(options.functions);
  if (!probe) return probe.error();
  for (int level = 0; level <= kMaxTileLevel; level += options.quick ? 8 : 1) check_level(level, *probe, checks);
  for (const HardPlace& place : kHardPlaces) {
    for (const double height_m : {1.0e2, 1.0e5, 2.0e7}) check_place(place, height_m, *probe, checks);
  }
  return Done{};
}

}  // namespace terrella::bench
