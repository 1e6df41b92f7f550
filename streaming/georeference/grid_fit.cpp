#include "streaming/georeference/grid_fit.h"

#include <cmath>

namespace terrella {
namespace {

/// Largest distance of an edge from the grid's pixels, pixels: the error of degrees with few decimals.
constexpr double kAlignment_px = 0.01;

bool near(double a, double b) { return std::abs(a - b) <= kAlignment_px; }

/// The next whole number if it is near, else the same number.
double snapped(double pixels) { return near(pixels, std::round(pixels)) ? std::round(pixels) : pixels; }

/// Columns of the whole turn; 0 if 360° is not a whole number of pixels.
std::int64_t turn_of(const PictureFile& picture, double pixel_deg) {
  const double turn = std::round(360.0 / pixel_deg);
  if (!(turn >= 1.0) || turn > 1e12) return 0;
  const double stretch = std::abs(360.0 / turn - pixel_deg) * static_cast<double>(picture.width_px);
  return stretch < kAlignment_px * pixel_deg ? std::llround(turn) : 0;
}

/// True for -180° to 180° and both poles. The rows of such a picture may be half a pixel too many or too few, if its
/// width is odd.
bool is_planet(const PictureFile& picture, const Placement& place) {
  const auto width = static_cast<double>(picture.width_px), height = static_cast<double>(picture.height_px);
  const double step = 360.0 / width;
  return std::abs(picture.width_px - 2 * picture.height_px) <= 1 && near(place.west_deg / step, -180.0 / step) &&
         near(place.north_deg / step, 90.0 / step) && near(place.pixel_width_deg * width / step, width) &&
         near(place.pixel_height_deg * height / step, 180.0 / step);
}

GeoRect rect_of(double west, double south, double east, double north) {
  return {.west = Angle::degrees(west),
          .south = Angle::degrees(south),
          .east = Angle::degrees(east),
          .north = Angle::degrees(north)};
}

}  // namespace

FittedPlace fit_to_grid(const PictureFile& picture, const Placement& place) {
  FittedPlace fitted;
  if (is_planet(picture, place)) {
    fitted.fit = GridFit::as_it_is;
    fitted.whole_planet = true;
    fitted.turn_px = picture.width_px;
    return fitted;
  }
  const std::int64_t turn = turn_of(picture, place.pixel_width_deg);
  const double pixel = turn > 0 ? 360.0 / static_cast<double>(turn) : place.pixel_width_deg;
  const double whole = 360.0 / pixel;
  const auto width = static_cast<double>(picture.width_px), height = static_cast<double>(picture.height_px);
  const double turns = std::floor((place.west_deg + 180.0) / 360.0 + kAlignment_px * pixel / 360.0);
  // Edges in pixels from (-180°, 90°).
  const double left = snapped((place.west_deg - 360.0 * turns + 180.0) / pixel);
  const double top = snapped((90.0 - place.north_deg) / pixel);
  const double below = top + height * place.pixel_height_deg / pixel;
  const bool is_square = near(below, top + height);
  const bool on_planet = top >= 0.0 && below <= 0.5 * whole + kAlignment_px && width <= whole + kAlignment_px;
  const bool goes_over = left + width > whole + kAlignment_px;
  const bool all_round = picture.width_px == turn;
  const bool meets_columns = turn > 0 && left == std::round(left);
  if (!is_square || !on_planet || ((goes_over || all_round) && !meets_columns)) return fitted;
  fitted.turn_px = turn;
  fitted.first_column = std::llround(left);
  const double west = -180.0 + left * pixel, north = 90.0 - top * pixel;
  const double south = near(below, 0.5 * whole) ? -90.0 : north - height * pixel;
  const double east = near(left + width, whole) ? 180.0 : west + width * pixel;
  fitted.fit = all_round && goes_over ? GridFit::rolled : GridFit::as_it_is;
  fitted.bounds = all_round ? rect_of(-180.0, south, 180.0, north)
                            : rect_of(west, south, east > 180.0 ? east - 360.0 : east, north);
  fitted.whole_planet = all_round && south == -90.0 && north == 90.0;
  return fitted;
}

}  // namespace terrella
