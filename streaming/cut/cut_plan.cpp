#include "streaming/cut/cut_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/range_check.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

/// Largest distance of the picture's edge from the pixels of its own grid, pixels: the error of degrees with six
/// decimals.
constexpr double kAlignment_px = 0.01;

constexpr int kMostMosaicSide = 100'000;
constexpr int kMostBands = 65'535;
/// Largest scale and offset of heights.
constexpr double kMostNumber = 1e9;

std::string name_of(const CutOptions& options) {
  return options.images.empty() ? std::string("picture") : options.images.front().string();
}

Status check_bands(const CutBands& composite) {
  RangeCheck check;
  for (const int band : composite.bands) check.in("bands", band, 1, kMostBands);
  for (const auto& stretch : composite.stretch) {
    if (!stretch) continue;
    check.known("the kind of a stretch", stretch->kind, StretchRule::Kind::sigma)
        .finite("the low end of a stretch", stretch->low)
        .finite("the high end of a stretch", stretch->high);
  }
  return check.result();
}

}  // namespace

Status check_options(const CutOptions& options) {
  if (options.tile_px < 16 || options.tile_px > 4096 || options.tile_px % 2 != 0) {
    return Error{fmt::format("tile size {}: it takes an even number of pixels from 16 to 4096", options.tile_px)};
  }
  if (options.quality < 1 || options.quality > 100) {
    return Error{fmt::format("quality {}: it takes 1 to 100", options.quality)};
  }
  if (options.jobs < 0 || options.jobs > 256) return Error{fmt::format("jobs {}: it takes 0 to 256", options.jobs)};
  const MosaicGrid mosaic = options.mosaic.value_or(MosaicGrid{});
  const CutElevation heights = options.elevation.value_or(CutElevation{});
  RangeCheck check;
  check.known("format", options.format.value_or(ImageFormat::jpeg), ImageFormat::webp)
      .known("grid", options.grid, CutGrid::web_mercator)
      .known("projection", options.projection, Projection::equal_area)
      .known("latitude", options.latitude.value_or(LatitudeKind::graphic), LatitudeKind::centric)
      .in("columns", mosaic.columns, 1, kMostMosaicSide)
      .in("rows", mosaic.rows, 1, kMostMosaicSide)
      .in("scale", heights.scale.value_or(1.0), -kMostNumber, kMostNumber)
      .that(heights.scale != 0.0, "scale is 0; give another")
      .in("offset", heights.offset.value_or(0.0), -kMostNumber, kMostNumber)
      .in("band", options.numbers.value_or(CutNumbers{}).band, 1, kMostBands)
      .in("west_deg", options.west_deg.value_or(0.0), -360.0, 360.0)
      .in("row_step", options.watch ? double(options.watch->row_step) : 1.0, 1, RangeCheck::kMost)
      .that(options.grid == CutGrid::geodetic || options.tile_px <= kMaxMercatorTilePx,
            "‹tile_px› is over 1024; in Web Mercator it is at most that")
      .that(!options.watch || options.grid == CutGrid::geodetic,
            "a cut in Web Mercator is not shown while it goes on; leave ‹grid› out");
  if (options.composite) check.part("composite", check_bands(*options.composite));
  return check.result();
}

namespace {

/// Chooses the coarsest root that needs at most two tiles round the planet.
Result<int> finest_level(double pixel_deg, int tile_px, const std::string& name) {
  constexpr double kRounding = 1.0 - 1e-9;
  int level = 0;
  while (std::ldexp(pixel_deg * tile_px, level) < 180.0 * kRounding) ++level;
  if (level <= kMaxTileLevel) return level;
  return Error{fmt::format("{}: pixels of {:.3g} degrees need {} levels, more than {}; give a larger ‹tile_px›", name,
                           pixel_deg, level + 1, kMaxTileLevel + 1)};
}

/// True if the grid has reduced rows. Reduction is strongest at the finest level next to a pole.
bool has_reduced_rows(const CutPlan& plan) {
  TileGrid grid = plan.grid;
  grid.reduced = true;
  const auto squeezed = [&](std::int64_t y_px) {
    return squeeze_of_row(grid, grid.max_level, y_px / grid.tile_px) > 0;
  };
  return squeezed(plan.finest.y0) || squeezed(plan.finest.y1 - 1);
}

Result<CutPlan> with_grid(CutPlan plan, const CutOptions& options) {
  const auto level = finest_level(plan.pixel_deg, options.tile_px, name_of(options));
  if (!level) return level.error();
  plan.grid.tile_px = options.tile_px;
  plan.grid.max_level = *level;
  plan.grid.root_span_deg = std::ldexp(plan.pixel_deg * options.tile_px, *level);
  plan.grid.projection = options.projection;
  plan.grid.latitude = options.latitude.value_or(LatitudeKind::graphic);
  plan.grid.reduced =
      plan.wraps && !options.elevation && !options.numbers && begins_at_planet(plan.grid) && has_reduced_rows(plan);
  return plan;
}

Result<CutPlan> plan_planet(const PictureInfo& picture, const CutOptions& options) {
  const std::int64_t width = picture.width_px;
  // Half of an odd width is no whole number of rows. Either neighbour is accepted.
  if (std::abs(width - 2 * picture.height_px) > 1) {
    return Error{fmt::format(
        "{0}: {1}x{2} pixels are not 2:1, so it is not a picture of a whole planet. Resize it to {3}x{4} if it "
        "is one; if it shows a part, say which with ‹bounds› W,S,E,N",
        name_of(options), width, picture.height_px, width + width % 2, (width + width % 2) / 2)};
  }
  CutPlan plan;
  plan.pixel_deg = 360.0 / static_cast<double>(width);
  plan.finest = {.x0 = 0, .y0 = 0, .x1 = width, .y1 = (width + 1) / 2};
  plan.wraps = true;
  plan.picture_rows = picture.height_px;
  return with_grid(plan, options);
}

struct Degrees {
  double west, south, east, north;
};

/// Removes rounding errors of the conversion from radians. A picture that crosses ±180° gets an east beyond 180°.
Degrees in_degrees(const GeoRect& rect) {
  const auto tidy = [](Angle angle) { return std::round(angle.deg() * 1e11) / 1e11; };
  const double turn = rect.east < rect.west ? 360.0 : 0.0;
  return {
      .west = tidy(rect.west), .south = tidy(rect.south), .east = tidy(rect.east) + turn, .north = tidy(rect.north)};
}

Status check_bounds(const Degrees& b, const std::string& name) {
  const bool on_planet = std::abs(b.west) <= 180.0 && b.east <= b.west + 360.0 && b.south >= -90.0 && b.north <= 90.0;
  if (on_planet && b.west < b.east && b.south < b.north && b.east < 540.0) return Done{};
  return Error{
      fmt::format("{}: bounds {},{},{},{}: it takes WEST and EAST in [-180, 180] (WEST > EAST crosses 180 degrees) and "
                  "SOUTH < NORTH in [-90, 90]",
                  name, b.west, b.south, b.east, b.north)};
}

/// Pixel size that follows from the bounds. Adjusted to a whole fraction of 360° if that moves no edge of the picture
/// noticeably.
double pixel_size_deg(const Degrees& b, std::int64_t width_px) {
  const double said = (b.east - b.west) / static_cast<double>(width_px);
  const double whole = 360.0 / std::round(360.0 / said);
  return std::abs(whole - said) * static_cast<double>(width_px) < kAlignment_px * said ? whole : said;
}

/// True if the distance is a whole number of pixels.
bool is_whole(double distance_deg, double pixel_deg) {
  const double pixels = distance_deg / pixel_deg;
  return std::abs(pixels - std::round(pixels)) <= kAlignment_px;
}

/// Places the first pixel. The grid begins at -180° and at 90° if these are a whole number of pixels away, else less
/// than a pixel beyond them.
Status place_first_pixel(CutPlan& plan, const Degrees& b, const std::string& name) {
  const double west_px = (b.west + 180.0) / plan.pixel_deg;
  const double north_px = (90.0 - b.north) / plan.pixel_deg;
  plan.finest.x0 = std::llround(west_px);
  plan.finest.y0 = std::llround(north_px);
  if (!is_whole(90.0 - b.north, plan.pixel_deg)) {
    plan.finest.y0 = static_cast<std::int64_t>(std::ceil(north_px));
    plan.grid.north_deg = b.north + static_cast<double>(plan.finest.y0) * plan.pixel_deg;
  }
  if (is_whole(b.west + 180.0, plan.pixel_deg)) return Done{};
  if (b.east > 180.0 || b.east - b.west >= 360.0) {
    return Error{
        fmt::format("{}: it goes over 180 degrees, and it begins {:.3f} pixels beside a grid of its own pixels from "
                    "-180; give bounds that fit, or cut it as two",
                    name, west_px - std::round(west_px))};
  }
  plan.finest.x0 = static_cast<std::int64_t>(std::ceil(west_px));
  plan.grid.west_deg = b.west - static_cast<double>(plan.finest.x0) * plan.pixel_deg;
  return Done{};
}

/// Checks a picture that crosses ±180°: it continues there at column 0, and no tile may be reached from both sides.
Status check_crossing(CutPlan& plan, const std::string& name) {
  const double turn = 360.0 / plan.pixel_deg;
  plan.turn_px = std::llround(turn);
  if (std::abs(turn - static_cast<double>(plan.turn_px)) > kAlignment_px) {
    return Error{
        fmt::format("{}: its pixels of {:.9g} degrees are no whole part of 360, so they do not go on beyond 180 "
                    "degrees; resample it, or cut it as two",
                    name, plan.pixel_deg)};
  }
  const auto root_column = [&](std::int64_t x) { return (x >> plan.grid.max_level) / plan.grid.tile_px; };
  if (root_column(plan.finest.x1 - plan.turn_px - 1) < root_column(plan.finest.x0)) return Done{};
  return Error{
      fmt::format("{}: it crosses 180 degrees and reaches into the same tile from both sides; give a smaller "
                  "‹tile_px›, or cut it as two",
                  name)};
}

GeoRect covered_by(const CutPlan& plan) {
  const auto lon = [&](std::int64_t x) { return plan.grid.west_deg + static_cast<double>(x) * plan.pixel_deg; };
  const auto lat = [&](std::int64_t y) { return plan.grid.north_deg - static_cast<double>(y) * plan.pixel_deg; };
  return {.west = Angle::degrees(lon(plan.finest.x0)),
          .south = Angle::degrees(std::max(-90.0, lat(plan.finest.y1))),
          .east = Angle::degrees(std::min(180.0, lon(plan.finest.x1 - plan.turn_px))),
          .north = Angle::degrees(lat(plan.finest.y0))};
}

Result<CutPlan> plan_region(const PictureInfo& picture, const CutOptions& options) {
  const std::string name = name_of(options);
  const Degrees b = in_degrees(*options.bounds);
  if (Status sane = check_bounds(b, name); !sane) return sane.error();
  const double pixel_deg = pixel_size_deg(b, picture.width_px);
  const auto height = static_cast<double>(picture.height_px);
  // A whole planet of odd width has half a row too few or too many (plan_planet()).
  const bool planet = b.west == -180.0 && b.east == 180.0 && b.south == -90.0 && b.north == 90.0;
  if (planet) return plan_planet(picture, options);
  // The last row may reach half a pixel beyond the south pole.
  const double beyond_px = height - (b.north - b.south) / pixel_deg;
  const double most_px = b.south == -90.0 ? 0.5 + kAlignment_px : kAlignment_px;
  if (beyond_px < -kAlignment_px || beyond_px > most_px) {
    return Error{
        fmt::format("{}: {}x{} pixels over these bounds are not square ({:.9g} degrees wide, {:.9g} high); check "
                    "‹bounds›, or resample the picture",
                    name, picture.width_px, picture.height_px, pixel_deg, (b.north - b.south) / height)};
  }
  CutPlan plan;
  plan.pixel_deg = pixel_deg;
  if (Status placed = place_first_pixel(plan, b, name); !placed) return placed.error();
  plan.finest.x1 = plan.finest.x0 + picture.width_px;
  plan.finest.y1 = plan.finest.y0 + picture.height_px;
  plan.picture_rows = picture.height_px;
  plan.wraps = b.west == -180.0 && b.east == 180.0;
  auto made = with_grid(plan, options);
  if (!made) return made;
  if (b.east > 180.0) {
    if (Status crosses = check_crossing(*made, name); !crosses) return crosses.error();
  }
  made->grid.bounds = covered_by(*made);
  return made;
}

}  // namespace

Result<CutPlan> plan_cut(const PictureInfo& picture, const CutOptions& options) {
  if (Status sane = check_options(options); !sane) return sane.error();
  return options.bounds ? plan_region(picture, options) : plan_planet(picture, options);
}

std::vector<CutPiece> pieces_of(const CutPlan& plan) {
  if (plan.turn_px == 0) return {{.plan = plan}};
  CutPiece western{.plan = plan};
  western.plan.finest.x1 = plan.turn_px;
  CutPiece eastern{.plan = plan, .first_column = plan.turn_px - plan.finest.x0};
  eastern.plan.finest.x0 = 0;
  eastern.plan.finest.x1 = plan.finest.x1 - plan.turn_px;
  return {western, eastern};
}

PixelRect pixels_at(const CutPlan& plan, int level) {
  const int shift = plan.grid.max_level - level;
  const std::int64_t rest = (std::int64_t{1} << shift) - 1;
  return {.x0 = plan.finest.x0 >> shift,
          .y0 = plan.finest.y0 >> shift,
          .x1 = (plan.finest.x1 + rest) >> shift,
          .y1 = (plan.finest.y1 + rest) >> shift};
}

bool is_planet(const CutPlan& plan) {
  const double rows_deg = top_row_deg(plan.grid) - bottom_row_deg(plan.grid);
  return plan.wraps && plan.finest.y0 == 0 && begins_at_planet(plan.grid) &&
         static_cast<double>(plan.finest.y1) * plan.pixel_deg > rows_deg - plan.pixel_deg;
}

double finest_row_area(const CutPlan& plan, std::int64_t y) {
  if (plan.grid.projection == Projection::equal_area) return 1.0;
  const bool mercator = plan.grid.projection == Projection::web_mercator;
  const auto sine = [&](std::int64_t edge) {
    const double row_deg = top_row_deg(plan.grid) - static_cast<double>(edge) * plan.pixel_deg;
    const double lat_deg = mercator ? latitude_of_mercator_row_deg(row_deg) : std::clamp(row_deg, -90.0, 90.0);
    return std::sin(lat_deg * (std::numbers::pi / 180.0));
  };
  return sine(y) - sine(y + 1);
}

}  // namespace terrella
