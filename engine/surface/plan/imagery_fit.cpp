#include "surface/plan/imagery_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "geo/longitudes.h"

namespace terrella {
namespace {

// A patch at a pole is split if a triangle has more pixels than this: pixels there need coordinates of their own, which
// cost more than a triangle for every twelve of them.
constexpr double kPixelsATriangle = 12.0;
// Beside a pole texels are narrow, but imagery has no finer detail there than elsewhere. A pixel that is short along
// the meridian needs taps for at most this many times its length there.
constexpr double kMostOverMeridian = 5.0;
// Texels this many times as large as a pixel show the loss of detail by squeezing.
constexpr double kMagnified = 2.0;
// A patch whose axis is further than this, in nearest distances, asks for one level less in its middle than near the
// eye: at its border texels would be four pixels wide.
constexpr double kMostOverNearest = 2.0;

double slant(double up) { return std::clamp(std::abs(up), 0.05, 1.0); }

}  // namespace

ImageryFit::ImageryFit(const FurtherImagery& imagery, const PatchSelectionOptions& options, const SightMeter& meter)
    : imagery_(imagery), options_(options), meter_(meter), band_rad_(options.band * std::numbers::pi) {
  const TileGrid& grid = imagery.tree->grid();
  equator_texel0_m_ = imagery.tree->ellipsoid().a_m() * (std::numbers::pi / 180.0) * grid.root_span_deg / grid.tile_px;
  finest_level_ = std::clamp(imagery.max_tile_level, grid.min_level, grid.max_level);
}

const PatchNode* ImageryFit::node_of(const PatchNode& body, const PatchSight& sight) const {
  const GeoRect& bounds = imagery_.tree->grid().bounds;
  const double wide_deg = std::max(0.0, body.east_deg - body.west_deg);
  if (!meets_longitudes(bounds, body.lon_center_deg + body.west_deg, wide_deg)) return nullptr;
  const PatchNode& node = imagery_.growth->node(body.id);
  if (node.north_row_deg < bounds.south.deg() || node.south_row_deg > bounds.north.deg()) return nullptr;
  const double texel_m = texel0_m(node) * imagery_.texels_per_pixel;
  return wanted_level(texel_m, pixel_m(sight)) < imagery_.least_level ? nullptr : &node;
}

// A patch of 45 degrees beside the limb has a slant of 70 degrees in its middle and of 40 on the side that faces the
// eye: by the slant of its middle it would be blurred there. Narrow texels of a full grid have detail to spare.
double ImageryFit::facing(const PatchSight& sight) const {
  return slant(imagery_.tree->grid().reduced ? sight.up_facing : sight.up);
}

// The nearest pixel, across the line of sight.
double ImageryFit::pixel_m(const PatchSight& sight) const {
  return sight.near_side_m * meter_.radians_per_pixel() / std::sqrt(facing(sight));
}

ImageryFit::Footprint ImageryFit::footprint(const PatchNode& node, const PatchSight& sight) const {
  const double east = (node.frame.x * sight.to_eye.y - node.frame.y * sight.to_eye.x) / sight.distance_m;
  const double flat = std::max(1e-9, std::sqrt(std::max(0.0, 1.0 - sight.up * sight.up)));
  const double sine = std::min(1.0, std::abs(east) / flat), cosine = std::sqrt(1.0 - sine * sine);
  const double across = sight.distance_m * meter_.radians_per_pixel(), along = across / slant(sight.up);
  return {std::sqrt(along * along * (sine * sine) + across * across * (cosine * cosine)),
          std::sqrt(along * along * (cosine * cosine) + across * across * (sine * sine))};
}

int ImageryFit::wanted_level(double texel0_m, double pixel_m) {
  const double level = std::ceil(std::log2(texel0_m / pixel_m) - 0.02);
  return static_cast<int>(std::clamp(level, -64.0, 64.0));
}

SelectedPatch ImageryFit::choose_level(const PatchNode& node, const PatchSight& sight) const {
  const PatchTree& tree = *imagery_.tree;
  const TileGrid& grid = tree.grid();
  const Footprint pixel = footprint(node, sight);
  const double span_deg = std::max(node.east_deg - node.west_deg, 0.0);
  SelectedPatch patch{.node = &node, .pixel_m = pixel_m(sight)};
  const double across_m = patch.pixel_m * std::pow(facing(sight), 0.5 - options_.slant_power);
  patch.tile_level =
      std::clamp(wanted_level(texel0_m(node) * imagery_.texels_per_pixel, across_m), grid.min_level, finest_level_);
  for (;; --patch.tile_level) {
    const double columns = span_deg / tile_span_deg(grid, patch.tile_level);
    // Squeezed tiles of the finest level have less detail than the picture: magnified, its loss would show.
    patch.squeezed = patch.tile_level < finest_level_ || texel_m(node, patch) < kMagnified * patch.pixel_m ||
                     columns > options_.max_polar_columns;
    patch.squeeze = patch.squeezed ? tree.window_squeeze(node, patch.tile_level) : 0;
    patch.footprint_texels = longest_texels(node, pixel, patch, std::max(node.min_colatitude_rad, 1e-3));
    // At a finer level a pixel would be longer than the taps and the gutter reach, or a pole's window too wide.
    const bool fits = in_band(node) ? std::ldexp(columns, -patch.squeeze) <= options_.max_polar_columns
                                    : patch.footprint_texels <= options_.max_footprint_texels;
    if (fits || patch.tile_level == grid.min_level) break;
  }
  if (!in_band(node)) return patch;
  patch.in_band =
      patch.footprint_texels > options_.max_footprint_texels || (touches_pole(node) && is_bent(node, sight));
  patch.footprint_texels = std::min(patch.footprint_texels, kMostOverMeridian * pixel.north_m / texel_m(node, patch));
  return patch;
}

// Texels are narrow along the parallel unless they are squeezed: there a pixel is long.
double ImageryFit::longest_texels(const PatchNode& node, const Footprint& pixel, const SelectedPatch& patch,
                                  double colatitude_rad) const {
  const double narrow = std::min(std::ldexp(std::sin(colatitude_rad), patch.squeeze), 1.0);
  return std::max(pixel.east_m / narrow, pixel.north_m) / texel_m(node, patch);
}

bool ImageryFit::is_bent(const PatchNode& node, const PatchSight& sight) const {
  const double px = meter_.corner_px_per_rad() / sight.nearest_m;
  return node.geometric_error_m * node.texture_error_factor * px > options_.max_error_px;
}

bool ImageryFit::needs_split(const PatchNode& body, const PatchSight& sight, const SelectedPatch& patch) const {
  if (is_bent(*patch.node, sight) && (!patch.in_band || is_worth_a_split(body, sight, patch))) return true;
  return window_too_wide(patch) || reaches_to_the_eye(sight, patch);
}

// True if the patch is large on the screen, and its half away from the pole does without coordinates per fragment.
bool ImageryFit::is_worth_a_split(const PatchNode& body, const PatchSight& sight, const SelectedPatch& patch) const {
  const PatchNode& node = *patch.node;
  const double outer_texels =
      longest_texels(node, footprint(node, sight), patch, 0.5 * (node.min_colatitude_rad + node.max_colatitude_rad));
  if (outer_texels > options_.max_footprint_texels) return false;
  const double radius_px = body.sphere.radius_m / (sight.distance_m * meter_.radians_per_pixel());
  const double pixels = 2.0 * radius_px * radius_px * std::abs(glm::dot(sight.to_eye, body.normal)) / sight.distance_m;
  const double segments = imagery_.tree->segments();
  return pixels > kPixelsATriangle * 2.0 * segments * segments;
}

// The tile level suits the patch's middle. A patch that is as large as the eye is near would be blurred under the eye.
bool ImageryFit::reaches_to_the_eye(const PatchSight& sight, const SelectedPatch& patch) const {
  return patch.tile_level < finest_level_ && sight.to_axis_m > kMostOverNearest * sight.nearest_m;
}

bool ImageryFit::window_too_wide(const SelectedPatch& patch) const {
  const PatchNode& node = *patch.node;
  const double most = options_.max_window * tile_span_deg(imagery_.tree->grid(), patch.tile_level);
  if (node.north_row_deg - node.south_row_deg > most) return true;
  return !in_band(node) && node.east_deg - node.west_deg > std::ldexp(most, patch.squeeze);
}

}  // namespace terrella
