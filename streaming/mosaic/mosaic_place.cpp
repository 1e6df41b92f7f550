#include "streaming/mosaic/mosaic_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "streaming/georeference/figure.h"
#include "streaming/georeference/placement.h"

namespace terrella {
namespace {

constexpr int kProbes = 8;  ///< points on each edge of a file
constexpr double kDegree = std::numbers::pi / 180.0;

/// Shifts of other turns that may make two boxes overlap.
constexpr std::array kTurns = {-360.0, 0.0, 360.0};

double overlap(double a0, double a1, double b0, double b1) { return std::min(a1, b1) - std::max(a0, b0); }

/// The outline of a file, `inset` pixels inside, as coordinates of its system.
std::vector<CrsPoint> outline(const MosaicFile& file, const Affine& to_crs, double inset) {
  const double right = static_cast<double>(file.width_px()) - inset,
               foot = static_cast<double>(file.height_px()) - inset;
  const auto on_way = [inset](double end, int i) { return inset + (end - inset) * i / kProbes; };
  std::vector<CrsPoint> points;
  for (int i = 0; i < kProbes; ++i) points.push_back(to_crs.at(on_way(right, i), inset));
  for (int i = 0; i < kProbes; ++i) points.push_back(to_crs.at(right, on_way(foot, i)));
  for (int i = 0; i < kProbes; ++i) points.push_back(to_crs.at(on_way(right, kProbes - i), foot));
  for (int i = 0; i < kProbes; ++i) points.push_back(to_crs.at(inset, on_way(foot, kProbes - i)));
  return points;
}

bool has_place(const RowPlace& place) { return std::isfinite(place.lon_deg) && std::isfinite(place.row_deg); }

/// Places of the outline. Pixels whose middle is a pole reach half a pixel beyond it: there the middle counts, or the
/// inner edge if the file's numbers are rounded and the middle is beyond the pole too.
std::vector<RowPlace> places_of_outline(const GroundMap& map, const MosaicFile& file, const Affine& to_crs) {
  std::vector<RowPlace> places = map.places(outline(file, to_crs, 0.0));
  for (const double inset : {0.5, 1.0}) {
    if (std::ranges::all_of(places, has_place)) break;
    const std::vector<RowPlace> inner = map.places(outline(file, to_crs, inset));
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!has_place(places[k])) places[k] = inner[k];
    }
  }
  return places;
}

bool is_inside(CrsPoint point, const MosaicFile& file, const Affine& t) {
  const double det = t.x_per_column * t.y_per_row - t.x_per_row * t.y_per_column;
  const double x = point.x - t.x0, y = point.y - t.y0;
  const double column = (x * t.y_per_row - y * t.x_per_row) / det;
  const double row = (y * t.x_per_column - x * t.y_per_column) / det;
  return column >= 0.0 && row >= 0.0 && column <= static_cast<double>(file.width_px()) &&
         row <= static_cast<double>(file.height_px());
}

/// Adds the pole if the file contains it; all longitudes meet there.
void add_poles(MosaicBox& box, const GroundMap& map, const MosaicFile& file, const Affine& to_crs) {
  for (const double pole : {-90.0, 90.0}) {
    const std::array place = {RowPlace{.lon_deg = box.west, .row_deg = pole}};
    std::array<CrsPoint, 1> point{};
    map.pixels(place, point);
    if (!std::isfinite(point[0].x) || !is_inside(point[0], file, to_crs)) continue;
    if (box.east - box.west < 180.0) continue;  // a cylindrical map, where the pole is an edge
    box = {-180.0, std::min(box.south, pole), 180.0, std::max(box.north, pole)};
  }
}

std::optional<MosaicBox> footprint(const GroundMap& map, const MosaicFile& file, const Affine& to_crs) {
  MosaicBox box{.west = 1e9, .south = 1e9, .east = -1e9, .north = -1e9};
  std::optional<double> before;
  for (const RowPlace& place : places_of_outline(map, file, to_crs)) {
    if (!has_place(place)) continue;
    double lon = place.lon_deg;
    if (before) lon -= 360.0 * std::round((lon - *before) / 360.0);
    before = lon;
    box = {std::min(box.west, lon), std::min(box.south, place.row_deg), std::max(box.east, lon),
           std::max(box.north, place.row_deg)};
  }
  if (!before || !(box.north > box.south) || !(box.east > box.west)) return {};
  add_poles(box, map, file, to_crs);
  if (box.east - box.west > 360.0) box = {-180.0, box.south, 180.0, box.north};
  const double turn = 360.0 * std::floor((box.west + 180.0) / 360.0);
  return MosaicBox{box.west - turn, std::max(box.south, -90.0), box.east - turn, std::min(box.north, 90.0)};
}

/// Metres on the ground in a unit of the second axis, at the middle of the file.
double metres_in_unit(const GroundMap& map, const MosaicFile& file, const Affine& to_crs, const Body& body) {
  const CrsPoint middle =
      to_crs.at(0.5 * static_cast<double>(file.width_px()), 0.5 * static_cast<double>(file.height_px()));
  const double step = std::hypot(to_crs.y_per_row, to_crs.y_per_column);
  const std::vector<RowPlace> ends = map.places(std::array{middle, CrsPoint{middle.x, middle.y + step}});
  const double east = std::remainder(ends[1].lon_deg - ends[0].lon_deg, 360.0) * std::cos(ends[0].row_deg * kDegree);
  const double degrees = std::hypot(east, ends[1].row_deg - ends[0].row_deg) / step;
  return std::isfinite(degrees) ? degrees * kDegree * body.ellipsoid.a_m() : 1.0;
}

/// Place of a whole planet from -180° on: of pixels, or of nodes at the middle of pixels. None for another shape.
std::optional<CrsPlace> whole_planet(const PictureFile& picture) {
  const double step = 360.0 / static_cast<double>(picture.width_px);
  const bool nodes = picture.width_px % 2 == 0 && picture.height_px == picture.width_px / 2 + 1;
  if (!nodes && picture.width_px != 2 * picture.height_px) return {};
  const double half = nodes ? 0.5 * step : 0.0;
  return CrsPlace{{.x0 = -180.0 - half, .x_per_column = step, .y0 = 90.0 + half, .y_per_row = -step}, "EPSG:4326"};
}

/// Place of a picture by its corners in degrees. Fails if they are no parallelogram within half a pixel.
Result<CrsPlace> place_of_corners(const MosaicFile& file, const std::array<CrsPoint, 4>& corners) {
  const auto& [low_left, low_right, high_right, high_left] = corners;
  const auto width = static_cast<double>(file.width_px()), height = static_cast<double>(file.height_px());
  const Affine to_crs{.x0 = high_left.x,
                      .x_per_column = (high_right.x - high_left.x) / width,
                      .x_per_row = (low_left.x - high_left.x) / height,
                      .y0 = high_left.y,
                      .y_per_column = (high_right.y - high_left.y) / width,
                      .y_per_row = (low_left.y - high_left.y) / height};
  const CrsPoint corner = to_crs.at(width, height);
  const double pixel =
      std::sqrt(std::abs(to_crs.x_per_column * to_crs.y_per_row - to_crs.x_per_row * to_crs.y_per_column));
  if (!to_crs.is_finite() || std::hypot(corner.x - low_right.x, corner.y - low_right.y) > 0.5 * pixel) {
    return Error{
        fmt::format("{}: its four corners are no parallelogram, in which a picture can lie; make a GeoTIFF of it "
                    "(gdal_translate -a_srs EPSG:4326 -gcp COLUMN ROW LON LAT for each corner, gdalwarp)",
                    file.path.string())};
  }
  return CrsPlace{to_crs, "EPSG:4326"};
}

/// A map whose pixels are units of the system.
Result<GroundMap> open_map(const std::string& crs, const Body& body, LatitudeKind latitude) {
  RasterInfo units{.name = {}, .attribution = {}, .crs = crs, .levels = {}};
  units.levels.push_back({.width_px = 1, .height_px = 1, .to_crs = {0.0, 1.0, 0.0, 0.0, 0.0, 1.0}});
  return GroundMap::open(units, {.ellipsoid = body.ellipsoid, .latitude = latitude, .crs_latitude = latitude});
}

}  // namespace

bool MosaicBox::meets(const MosaicBox& other) const {
  if (overlap(south, north, other.south, other.north) <= 0.0) return false;
  return std::ranges::any_of(
      kTurns, [&](double turn) { return overlap(west, east, other.west + turn, other.east + turn) > 0.0; });
}

double MosaicBox::shared_area(const MosaicBox& other) const {
  const double high = std::max(0.0, overlap(south, north, other.south, other.north));
  double wide = 0.0;
  for (const double turn : kTurns) wide += std::max(0.0, overlap(west, east, other.west + turn, other.east + turn));
  return wide * high;
}

Result<MosaicPlace> MosaicPlacer::place_at(const MosaicFile& file, const CrsPlace& at, LatitudeKind latitude) {
  auto known = systems_.find(at.crs);
  if (known == systems_.end()) {
    auto map = open_map(at.crs, figure_.body, latitude);
    if (!map) return Error{fmt::format("{}: {}", file.path.string(), map.error().message)};
    known = systems_.emplace(at.crs, MosaicSystem{.latitude = latitude, .map = *std::move(map)}).first;
  }
  const MosaicSystem& system = known->second;
  const auto box = footprint(system.map, file, at.to_crs);
  if (!box) return Error{fmt::format("{}: none of its pixels has a place on the planet", file.path.string())};
  const Affine& t = at.to_crs;
  const double area = std::abs(t.x_per_column * t.y_per_row - t.x_per_row * t.y_per_column);
  return MosaicPlace{.at = at,
                     .box = *box,
                     .latitude = latitude,
                     .pixel_units = std::sqrt(area),
                     .unit_m = metres_in_unit(system.map, file, at.to_crs, figure_.body)};
}

Result<CrsPlace> MosaicPlacer::read_place(const MosaicFile& file, const PlaceWords& words, LatitudeKind& latitude) {
  const PictureFile picture{file.path, file.width_px(), file.height_px(), file.raster};
  if (words == PlaceWords{}) {
    const auto said = read_georeference(picture);
    if (said && *said && (*said)->transform && !(*said)->crs.empty()) {
      const auto known = systems_.find((*said)->crs);
      if (known != systems_.end()) {
        latitude = known->second.latitude;
        return CrsPlace{*(*said)->transform, (*said)->crs};
      }
    }
  }
  auto placed = place_picture(picture, words);
  if (!placed) return placed.error();
  const auto checked = check_figure(*placed, figure_.body, figure_.latitude);
  if (!checked) return checked.error();
  if (!placed->projected && figure_.may_be_planet) placed->projected = whole_planet(picture);
  if (!placed->projected) {
    return Error{
        fmt::format("{}: states no place, and a mosaic's files must; write it into a copy (gdal_translate "
                    "-a_srs CRS -a_ullr W N E S), or describe the mosaic by a JSON file with \"bounds\"",
                    file.path.string())};
  }
  latitude = *checked;
  return *placed->projected;
}

Result<MosaicPlace> MosaicPlacer::place(const MosaicFile& file, const MosaicEntry& entry) {
  LatitudeKind latitude = figure_.latitude.value_or(LatitudeKind::graphic);
  const auto at = entry.corners ? place_of_corners(file, *entry.corners) : read_place(file, entry.words, latitude);
  if (!at) return at.error();
  return place_at(file, *at, latitude);
}

}  // namespace terrella
