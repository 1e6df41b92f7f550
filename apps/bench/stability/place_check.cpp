#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include "apps/bench/stability/check.h"
#include "apps/bench/stability/patch_probe.h"

namespace terrella::bench {
namespace {

constexpr Viewport kPlacePicture{256, 256};
constexpr double kMostPlaceOff_px = 0.25;
// Texels here are about as large as pixels.
constexpr double kMostOff_texels = 0.25;

struct PlaceErrors {
  double interpolated_texels = 0.0;  ///< of patches that the engine draws so
  double exact_texels = 0.0;         ///< of the others, and of all patches
  double drawn_px = 0.0;             ///< of what the engine draws, on the screen
  int holes = 0;                     ///< pixels of the globe where there is none
};

/// Judges pixel by pixel against the ray through it, in double.
class PlaceJudge {
 public:
  explicit PlaceJudge(const PatchScene& scene) : scene_(scene) {}

  PlaceErrors judge(const std::vector<WindowPixel>& pixels) {
    PlaceErrors errors;
    for (int y = 0; y < kPlacePicture.height_px; ++y) {
      for (int x = 0; x < kPlacePicture.width_px; ++x) {
        const auto row = static_cast<std::size_t>(kPlacePicture.height_px - 1 - y);
        add({x + 0.5, y + 0.5},
            pixels[row * static_cast<std::size_t>(kPlacePicture.width_px) + static_cast<std::size_t>(x)], errors);
      }
    }
    return errors;
  }

 private:
  void add(glm::dvec2 pixel_px, const WindowPixel& pixel, PlaceErrors& errors) const {
    const Ellipsoid& e = scene_.tree.ellipsoid();
    const std::optional<Geodetic> place = pick(scene_.view, e, pixel_px);
    if (!place) return;
    if (pixel.patch == 0) {
      if (!near_limb(pixel_px)) ++errors.holes;
      return;
    }
    if (near_limb(pixel_px)) return;  // a fragment's place there is anybody's guess: the surface is seen from its side
    const SelectedPatch& patch = scene_.patches[pixel.patch - 1];
    const double interpolated = off_texels(patch, *place, {pixel.points.x, pixel.points.y});
    const double exact = off_texels(patch, *place, {pixel.points.z, pixel.points.w});
    if (!patch.in_band) errors.interpolated_texels = std::max(errors.interpolated_texels, interpolated);
    errors.exact_texels = std::max(errors.exact_texels, exact);
    errors.drawn_px = std::max(errors.drawn_px, (patch.in_band ? exact : interpolated) * texel_px(patch, *place));
  }

  // Texels of the patch's level; those along a parallel as much narrower as it is shorter than the equator.
  [[nodiscard]] double off_texels(const SelectedPatch& patch, const Geodetic& place, glm::dvec2 point) const {
    const PatchNode& node = *patch.node;
    const TileGrid& grid = scene_.tree.grid();
    const double lon_deg = node.lon_center_deg + wrapped_deg(place.lon.deg() - node.lon_center_deg);
    const TileXY xy = tile_xy(grid, node.window.level, place.lat.deg(), lon_deg);
    const glm::dvec2 off(point.x - (xy.x - static_cast<double>(node.window.x0)),
                         point.y - (xy.y - static_cast<double>(node.window.y0)));
    return std::hypot(off.x * std::cos(place.lat.rad()), off.y) * grid.tile_px;
  }

  [[nodiscard]] double texel_px(const SelectedPatch& patch, const Geodetic& place) const {
    const Ellipsoid& e = scene_.tree.ellipsoid();
    const double texel_m = Angle::degrees(tile_span_deg(scene_.tree.grid(), patch.node->window.level)).rad() * e.a_m() /
                           scene_.tree.grid().tile_px;
    const double distance_m = glm::distance(e.to_ecef(place).xyz_m, scene_.view.eye.xyz_m);
    return texel_m / distance_m * scene_.view.pixels_per_radian();
  }

  // Within a pixel and a half of where rays begin to miss.
  [[nodiscard]] bool near_limb(glm::dvec2 pixel_px) const {
    const std::array<glm::dvec2, 4> around{{{1.5, 0.0}, {-1.5, 0.0}, {0.0, 1.5}, {0.0, -1.5}}};
    return std::ranges::any_of(around, [&](glm::dvec2 step) {
      return !scene_.tree.ellipsoid().intersect_m(scene_.view.eye, pixel_ray(scene_.view, pixel_px + step));
    });
  }

  const PatchScene& scene_;
};

/// How many vertices that patches share come out at two places.
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

// Texels of this level are about as large as pixels.
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
    probe.load(scene);
    errors = PlaceJudge(scene).judge(probe.window_pixels());
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
    probe.load(scene);
    errors = PlaceJudge(scene).judge(probe.window_pixels());
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
