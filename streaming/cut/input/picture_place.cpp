#include "streaming/cut/input/picture_place.h"

#include <fmt/format.h>

#include <cmath>

#include "geo/body.h"
#include "streaming/cut/cut_plan.h"
#include "streaming/cut/input/height_input.h"
#include "streaming/georeference/figure.h"
#include "streaming/georeference/gdal_advice.h"
#include "streaming/georeference/grid_fit.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/raster/raster_file.h"

namespace terrella {
namespace {

/// True if the place is that of a planet sampled at nodes: the nodes are centres of pixels that reach half a pixel
/// beyond the planet.
bool lies_on_nodes(const Placement& place, const PictureFile& picture) {
  const double step = 360.0 / static_cast<double>(picture.width_px);
  const auto near = [step](double a, double b) { return std::abs(a - b) <= 0.01 * step; };
  const auto height = static_cast<double>(picture.height_px);
  return near(place.west_deg, -180.0 - 0.5 * step) && near(place.north_deg, 90.0 + 0.5 * step) &&
         near(place.pixel_width_deg * static_cast<double>(picture.width_px), 360.0) &&
         near(place.pixel_height_deg * height, step * height);
}

/// Puts an evenly spaced picture onto the grid's pixels; false if they do not fit.
bool put_on_grid(const CutOptions& options, const PictureFile& picture, const Placement& at, PicturePlace& place) {
  const FittedPlace fitted = fit_to_grid(picture, at);
  if (fitted.fit == GridFit::none) return false;
  place.kind = fitted.fit == GridFit::rolled ? PlaceKind::rolled : PlaceKind::as_it_is;
  place.first_column = fitted.first_column;
  place.turn_px = fitted.turn_px;
  place.bounds = fitted.bounds;
  const PictureInfo size{.width_px = picture.width_px, .height_px = picture.height_px};
  if (place.kind == PlaceKind::as_it_is && meets_itself(options, size, fitted.bounds)) {
    place.kind = PlaceKind::rolled;
    place.bounds = all_round(fitted.bounds);
  }
  // A planet without bounds may have an odd width, and half of that is no whole number of rows.
  if (fitted.whole_planet) place.bounds.reset();
  return true;
}

}  // namespace

Result<Body> body_of(const CutOptions& options) {
  return options.body.empty() ? Result<Body>(earth()) : parse_body(options.body);
}

bool meets_itself(const CutOptions& options, const PictureInfo& picture, const GeoRect& bounds) {
  if (bounds.east >= bounds.west) return false;
  // The roots of Web Mercator then meet at 0°.
  const bool past_zero = bounds.west.deg() < 0.0 || bounds.east.deg() > 0.0;
  if (options.grid == CutGrid::web_mercator && past_zero) return true;
  CutOptions placed = options;
  placed.bounds = bounds;
  return !plan_cut(picture, placed);
}

GeoRect all_round(const GeoRect& bounds) { return {.south = bounds.south, .north = bounds.north}; }

PlaceWords words_of(const CutOptions& options) {
  PlaceWords words{.crs = options.crs, .bounds = options.crs_bounds, .west_deg = options.west_deg};
  if (options.bounds) {
    const GeoRect& b = *options.bounds;
    words.bounds = CrsBounds{b.west.deg(), b.south.deg(), b.east.deg(), b.north.deg()};
  }
  return words;
}

Result<PicturePlace> find_place(const CutOptions& options, const PictureFile& picture) {
  auto placed = place_picture(picture, words_of(options));
  if (!placed) return placed.error();
  const auto body = body_of(options);
  if (!body) return body.error();
  const auto latitude = check_figure(*placed, *body, options.latitude);
  if (!latitude) return latitude.error();
  PicturePlace place{.latitude = *latitude, .placed = *std::move(placed)};
  const auto& at = place.placed.placement;
  const bool node_sides = options.elevation && is_node_planet(picture.width_px, picture.height_px);
  if (!place.placed.projected) {
    if (node_sides) place.kind = PlaceKind::nodes;
    return place;
  }
  if (at && node_sides && lies_on_nodes(*at, picture)) {
    place.kind = PlaceKind::nodes;
    return place;
  }
  if (at && put_on_grid(options, picture, *at, place)) return place;
  place.kind = PlaceKind::warped;
  place.from = place.placed.projected;
  return place;
}

Result<PicturePlace> find_joined_place(const CutOptions& options, const PictureFile& joined,
                                       std::optional<Placement> at) {
  const PlaceWords words = words_of(options);
  if (words.say_place()) {
    if (!words.crs.empty() && words.bounds) {
      return Error{"‹crs› with ‹bounds› places one picture; join the parts first: " + join_command(options.images)};
    }
    const auto said = place_of_words(joined, words);
    if (!said) return said.error();
    at = *said;
  }
  PicturePlace place;
  if (!at || put_on_grid(options, joined, *at, place)) return place;
  return Error{fmt::format(
      "{}: the mosaic's pixels of {:.9g} by {:.9g} degrees with the corner at longitude {:.9g}, latitude {:.9g} do not "
      "fit a grid, and parts are not resampled; make one picture of them: {}",
      joined.path.string(), at->pixel_width_deg, at->pixel_height_deg, at->west_deg, at->north_deg,
      join_command(options.images))};
}

std::string place_text(const PicturePlace& place) {
  const GeoRect b = place.bounds.value_or(GeoRect{});
  std::string text = fmt::format("{}|{:a},{:a},{:a},{:a}|{}|{}", static_cast<int>(place.kind), b.west.rad(),
                                 b.south.rad(), b.east.rad(), b.north.rad(), static_cast<int>(place.latitude),
                                 place.kind == PlaceKind::rolled ? place.first_column : 0);
  if (!place.from) return text;
  const Affine& t = place.from->to_crs;
  return text + fmt::format("|{:a},{:a},{:a},{:a},{:a},{:a}|{}", t.x0, t.x_per_column, t.x_per_row, t.y0,
                            t.y_per_column, t.y_per_row, place.from->crs);
}

Result<std::optional<TileGrid>> grid_of_pixels(const CutOptions& options, const PictureFile& picture) {
  const auto place = find_place(options, picture);
  if (!place) return place.error();
  if (place->kind == PlaceKind::warped || place->kind == PlaceKind::nodes) return std::optional<TileGrid>{};
  CutOptions placed = options;
  placed.bounds = place->bounds;
  placed.latitude = place->latitude;
  PictureInfo size{.width_px = picture.width_px, .height_px = picture.height_px};
  if (place->kind == PlaceKind::rolled) size.width_px = place->turn_px;
  const auto plan = plan_cut(size, placed);
  if (!plan) return plan.error();
  return std::optional(plan->grid);
}

Result<PictureFile> measure_picture(const std::filesystem::path& picture) {
  if (picture_kind(picture) == PictureKind::raster) return measure_raster(picture);
  const auto rows = open_rows(picture);
  if (!rows) return rows.error();
  return PictureFile{picture, (*rows)->info().width_px, (*rows)->info().height_px};
}

Result<PictureFile> picture_of(const CutOptions& options) {
  return options.picture ? Result<PictureFile>(*options.picture) : measure_picture(options.images.front());
}

void set_stated_body(CutOptions& options) {
  const auto picture = picture_of(options);
  if (picture) options.body = stated_body(*picture, words_of(options));
}

}  // namespace terrella
