#include "streaming/georeference/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "streaming/georeference/gdal_advice.h"
#include "streaming/georeference/warp_extent.h"

namespace terrella {
namespace {

constexpr double kPlaced_px = 0.01;
/// Number of pixel corners transformed along each side. Projections are smooth between them.
constexpr int kProbes = 17;
constexpr double kOtherBody = 0.01;
/// Largest plausible longitude and latitude: an extra turn, and half a pixel of a coarse picture.
constexpr double kMostLongitude_deg = 540.0;
constexpr double kMostLatitude_deg = 100.0;

std::string crs_text(const CrsFacts& crs, const std::string& title) {
  const bool named = !crs.name.empty() && crs.name != "unknown";
  std::string text = named ? crs.name : (title.empty() ? std::string("a system without a name") : title);
  if (!crs.code.empty()) text += ", " + crs.code;
  if (!crs.geographic) text += ", " + crs.method;
  if (crs.central_meridian_deg) text += fmt::format(" with central meridian {:.9g} degrees", *crs.central_meridian_deg);
  return text;
}

/// Statement of the picture, as the beginning of a message.
std::string claim_text(const PictureFile& picture, const Georeference& said, const std::optional<CrsFacts>& crs) {
  if (!crs) return fmt::format("{}: its {}", picture.path.string(), said.source);
  return fmt::format("{}: its {} say that it is {} ({})", picture.path.string(), said.source,
                     crs->geographic ? "geographic" : "projected", crs_text(*crs, said.crs_title));
}

std::vector<CrsPoint> probes(const PictureFile& picture, const Affine& transform) {
  std::vector<CrsPoint> points;
  for (int j = 0; j < kProbes; ++j) {
    for (int i = 0; i < kProbes; ++i) {
      points.push_back(transform.at(static_cast<double>(picture.width_px) * i / (kProbes - 1),
                                    static_cast<double>(picture.height_px) * j / (kProbes - 1)));
    }
  }
  return points;
}

/// Continues longitudes over ±180° along each row of probes.
void unwrap(std::vector<CrsPoint>& places) {
  for (std::size_t k = 1; k < places.size(); ++k) {
    const CrsPoint& before = places[k % kProbes == 0 ? k - kProbes : k - 1];
    places[k].x -= 360.0 * std::round((places[k].x - before.x) / 360.0);
  }
}

/// Place with evenly spaced longitudes and latitudes, within kPlaced_px; none if the spacing is uneven.
std::optional<Placement> evenly_spaced(std::vector<CrsPoint> places, const PictureFile& picture) {
  if (!std::ranges::all_of(places, [](const CrsPoint& p) { return std::isfinite(p.x) && std::isfinite(p.y); }))
    return {};
  unwrap(places);
  const CrsPoint first = places.front(), last = places.back();
  const double width = (last.x - first.x) / static_cast<double>(picture.width_px);
  const double height = (first.y - last.y) / static_cast<double>(picture.height_px);
  if (!(width > 0.0) || !(height > 0.0)) return {};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double x = first.x + (last.x - first.x) * static_cast<double>(k % kProbes) / (kProbes - 1);
    const double y = first.y + (last.y - first.y) * static_cast<double>(k / kProbes) / (kProbes - 1);
    if (std::abs(places[k].x - x) > kPlaced_px * width || std::abs(places[k].y - y) > kPlaced_px * height) return {};
  }
  return Placement{.west_deg = first.x, .north_deg = first.y, .pixel_width_deg = width, .pixel_height_deg = height};
}

/// Moves the place into the first turn, because a projection's western end may be returned as 180 degrees.
void begin_in_first_turn(Placement& place) {
  const double slack = kPlaced_px * place.pixel_width_deg;
  place.west_deg -= 360.0 * std::floor((place.west_deg + 180.0 + slack) / 360.0);
}

bool are_degrees(const Affine& transform, const PictureFile& picture) {
  const CrsPoint a = transform.at(0.0, 0.0);
  const CrsPoint b = transform.at(static_cast<double>(picture.width_px), static_cast<double>(picture.height_px));
  return std::abs(a.x) <= kMostLongitude_deg && std::abs(b.x) <= kMostLongitude_deg &&
         std::abs(a.y) <= kMostLatitude_deg && std::abs(b.y) <= kMostLatitude_deg;
}

/// Place without a coordinate system. Numbers count as degrees if possible.
Result<Placement> place_without_crs(const PictureFile& picture, const Georeference& said) {
  const Affine& t = *said.transform;
  const bool plain = !t.is_turned() && t.x_per_column > 0.0 && t.y_per_row < 0.0;
  if (plain && are_degrees(t, picture)) {
    return Placement{
        .west_deg = t.x0, .north_deg = t.y0, .pixel_width_deg = t.x_per_column, .pixel_height_deg = -t.y_per_row};
  }
  return Error{fmt::format(
      "{} put its corner at ({:.9g}, {:.9g}) with pixels of {:.6g} by {:.6g}{}, which are no degrees from the "
      "north-west, and name no coordinate system; say which with the code that the picture's source gives: {}",
      claim_text(picture, said, {}), t.x0, t.y0, std::hypot(t.x_per_column, t.y_per_column),
      std::hypot(t.x_per_row, t.y_per_row), t.is_turned() ? ", turned" : "",
      warp_command(picture, {.to_crs = "EPSG:4326", .from_crs = "EPSG:CODE", .grid = {}, .relabelled = {}}))};
}

/// End of a message for a picture that will need further options.
std::string then_say(const CrsFacts& crs) {
  const std::string options = needed_options(crs).text();
  return options.empty() ? options : fmt::format(", and show the result with{}", options);
}

Error not_placed(const PictureFile& picture, const Georeference& said, const Crs& crs,
                 const std::vector<CrsPoint>& at) {
  const bool lies_even = said.transform && !said.transform->is_turned();
  std::string why = crs.facts().geographic ? "its columns are no meridians from west to east" : "";
  if (said.transform && said.transform->is_turned()) why = "it is turned";
  if (lies_even && said.transform->y_per_row > 0.0) why = "its rows go from south to north";
  const auto extent = warp_extent(picture, said, crs);
  const WarpAdvice advice{.to_crs = crs.degrees_text(),
                          .from_crs = said.gdal_reads_crs ? std::string() : said.crs,
                          .grid = extent,
                          .relabelled = {}};
  const bool nowhere = std::ranges::none_of(at, [](const CrsPoint& p) { return std::isfinite(p.x); });
  if (nowhere) why = "no pixel of it has a place on the planet by that";
  return Error{fmt::format("{}{}, and only longitudes and latitudes in even steps are drawn; resample it{}: {}",
                           claim_text(picture, said, crs.facts()), why.empty() ? "" : ", " + why, then_say(crs.facts()),
                           warp_command(picture, advice))};
}

/// Error for control points and camera models.
Error points_alone(const PictureFile& picture, const Georeference& said, const std::optional<CrsFacts>& crs,
                   const std::string& to) {
  const char* what = said.has_camera_model ? "a camera model (RPC)" : "ground control points";
  std::string command = warp_command(
      picture, {.to_crs = to, .from_crs = crs ? std::string() : "EPSG:CODE", .grid = {}, .relabelled = {}});
  if (said.has_camera_model) command.replace(command.find("gdalwarp"), 8, "gdalwarp -rpc");
  return Error{fmt::format("{}: its {} place it by {}, not by a grid; resample it: {}", picture.path.string(),
                           said.source, what, command)};
}

/// Place in a known coordinate system.
Result<PlacedPicture> place_in(const PictureFile& picture, Georeference said, const Crs& crs) {
  PlacedPicture placed{.said = {}, .crs = crs.facts(), .placement = {}};
  if (said.has_control_points || said.has_camera_model) {
    return points_alone(picture, said, placed.crs, crs.degrees_text());
  }
  if (said.transform) {
    const auto places = crs.places(probes(picture, *said.transform));
    if (!places) return Error{fmt::format("{}: {}", picture.path.string(), places.error().message)};
    placed.placement = evenly_spaced(*places, picture);
    if (!placed.placement) return not_placed(picture, said, crs, *places);
    if (!crs.facts().geographic) begin_in_first_turn(*placed.placement);
    const bool plausible = std::abs(placed.placement->west_deg) <= kMostLongitude_deg &&
                           std::abs(placed.placement->north_deg) <= kMostLatitude_deg;
    if (!plausible) {
      return Error{fmt::format(
          "{}, and put its corner at longitude {:.9g}, latitude {:.9g}; write what is right into a copy: {}",
          claim_text(picture, said, placed.crs), placed.placement->west_deg, placed.placement->north_deg,
          assign_command(picture))};
    }
  } else if (!crs.facts().geographic) {
    return Error{fmt::format("{}, and not where; write it into a copy: {}", claim_text(picture, said, placed.crs),
                             assign_command(picture))};
  }
  placed.said = std::move(said);
  return placed;
}

std::string body_name(double a_m, double b_m) {
  const Body* nearest = nullptr;
  for (const Body& body : body_presets()) {
    const auto off = [a_m](const Body& b) { return std::abs(b.ellipsoid.a_m() - a_m); };
    if (off(body) < kOtherBody * body.ellipsoid.a_m() && (nearest == nullptr || off(body) < off(*nearest)))
      nearest = &body;
  }
  if (nearest != nullptr) return nearest->name;
  return fmt::format("{:.10g},{:.10g}", a_m, std::max(0.0, 1.0 - b_m / a_m));
}

bool is_other_body(const CrsFacts& crs, const Body& body) {
  return std::abs(crs.a_m - body.ellipsoid.a_m()) > kOtherBody * body.ellipsoid.a_m();
}

/// True if the latitudes are planetocentric: those on a sphere that stands for an ellipsoid, as in USGS's maps. On
/// Earth such latitudes count as geodetic, by common practice.
bool counts_centric(const CrsFacts& crs, const Body& body) {
  const bool is_earth = std::abs(body.ellipsoid.a_m() - earth().ellipsoid.a_m()) < kOtherBody * earth().ellipsoid.a_m();
  const bool stands_in = crs.a_m == crs.b_m && body.ellipsoid.f() > 0.0;
  return body.ellipsoid.f() > 0.0 && (crs.centric || (stands_in && !is_earth));
}

/// Largest difference between both kinds of latitude, degrees (2 atan(e²/…) to first order: the flattening in radians).
double latitudes_apart_deg(const Body& body) { return body.ellipsoid.f() * 180.0 / M_PI; }

}  // namespace

NeededOptions needed_options(const CrsFacts& crs) {
  NeededOptions needed;
  const std::string name = body_name(crs.a_m, crs.b_m);
  const auto body = parse_body(name);
  if (is_other_body(crs, earth())) needed.body = name;
  needed.centric = body && counts_centric(crs, *body);
  return needed;
}

std::string NeededOptions::text() const {
  return (body.empty() ? std::string() : " --body " + body) + (centric ? " --latitude centric" : "");
}

Result<PlacedPicture> place_picture(const PictureFile& picture) {
  auto said = read_georeference(picture);
  if (!said) return said.error();
  if (!*said) return PlacedPicture{};
  if (!(*said)->crs.empty()) {
    const auto crs = Crs::open((*said)->crs);
    if (!crs) {
      return Error{fmt::format("{}: its {}: {}; write what is right into a copy: {}", picture.path.string(),
                               (*said)->source, crs.error().message, assign_command(picture))};
    }
    return place_in(picture, **std::move(said), *crs);
  }
  if ((*said)->has_control_points || (*said)->has_camera_model) return points_alone(picture, **said, {}, "EPSG:4326");
  PlacedPicture placed{.said = {}, .crs = {}, .placement = {}};
  if ((*said)->transform) {
    const auto place = place_without_crs(picture, **said);
    if (!place) return place.error();
    placed.placement = *place;
  }
  placed.said = **std::move(said);
  return placed;
}

Status check_figure(const PictureFile& picture, const PlacedPicture& placed, const Body& body, LatitudeKind latitude) {
  if (!placed.crs) return Done{};
  const CrsFacts& crs = *placed.crs;
  if (is_other_body(crs, body)) {
    const std::string needed = needed_options(crs).text();
    return Error{fmt::format("{}, a body of {:.9g} m radius, and {} has {:.9g}; say which it is: {}",
                             claim_text(picture, *placed.said, crs), crs.a_m, body.name, body.ellipsoid.a_m(),
                             needed.empty() ? std::string("--body earth") : needed.substr(1))};
  }
  const double pixel_deg =
      placed.placement ? placed.placement->pixel_height_deg : 180.0 / static_cast<double>(picture.height_px);
  const bool matters = latitudes_apart_deg(body) > kPlaced_px * pixel_deg;
  if (latitude == LatitudeKind::centric || !matters || !counts_centric(crs, body)) return Done{};
  return Error{fmt::format(
      "{} on {} of {:.9g} m, while {} is flattened: its latitudes are planetocentric, up to {:.2g} "
      "degrees from the planetographic ones; say so: --latitude centric (for a layer over another: in `terrella cut`)",
      claim_text(picture, *placed.said, crs), crs.a_m == crs.b_m ? "a sphere" : "an ellipsoid", crs.a_m, body.name,
      latitudes_apart_deg(body))};
}

Result<GeoRect> covered_by(const PictureFile& picture, const Placement& place) {
  const double wide = static_cast<double>(picture.width_px) * place.pixel_width_deg;
  const double slack = kPlaced_px * place.pixel_width_deg;
  const auto snapped = [slack](double value, double to) { return std::abs(value - to) <= slack ? to : value; };
  const double north = snapped(place.north_deg, 90.0);
  const double south =
      snapped(place.north_deg - static_cast<double>(picture.height_px) * place.pixel_height_deg, -90.0);
  double west = snapped(place.west_deg - 360.0 * std::floor((place.west_deg + 180.0 + slack) / 360.0), -180.0);
  double east = snapped(snapped(west + wide, 180.0), west + 360.0);
  if (north > 90.0 || south < -90.0 || east > west + 360.0) {
    return Error{
        fmt::format("{}: covers {:.9g} to {:.9g} degrees of longitude and {:.9g} to {:.9g} of latitude, which "
                    "is more than a planet has",
                    picture.path.string(), place.west_deg, place.west_deg + wide, south, north)};
  }
  if (east == west + 360.0 && west != -180.0) {
    return Error{
        fmt::format("{}: covers all longitudes from {:.9g} degrees on, and pictures of all longitudes must "
                    "begin at -180",
                    picture.path.string(), place.west_deg)};
  }
  if (east > 180.0) east -= 360.0;
  return GeoRect{.west = Angle::degrees(west),
                 .south = Angle::degrees(south),
                 .east = Angle::degrees(east),
                 .north = Angle::degrees(north)};
}

std::string resample_command(const PictureFile& picture, const PlacedPicture& placed) {
  const Placement& place = *placed.placement;
  const double pixel = std::min(place.pixel_width_deg, place.pixel_height_deg);
  const double east = place.west_deg + static_cast<double>(picture.width_px) * place.pixel_width_deg;
  const double south = place.north_deg - static_cast<double>(picture.height_px) * place.pixel_height_deg;
  const bool all_round = east - place.west_deg > 360.0 - 1.5 * place.pixel_width_deg;
  const double turn = 360.0 * std::floor((place.west_deg + 180.0) / 360.0 + 1e-9);
  WarpAdvice advice;
  advice.grid = all_round ? grid_over(-180.0, south, 180.0, place.north_deg, pixel)
                          : grid_over(place.west_deg - turn, south, east - turn, place.north_deg, pixel);
  if (placed.crs) {
    if (const auto crs = Crs::open(placed.said->crs)) advice.to_crs = crs->degrees_text();
    if (!placed.said->gdal_reads_crs) advice.from_crs = placed.said->crs;
    // GDAL fails beyond the ends of a projection, where such a picture may extend.
    const double middle = placed.crs->central_meridian_deg.value_or(0.0);
    const bool beyond = place.west_deg < middle - 180.0 - 1e-9 || east > middle + 180.0 + 1e-9;
    if (!placed.crs->geographic && beyond) {
      advice.relabelled = DegreeGrid{place.west_deg, south, east, place.north_deg, 0, 0};
    }
  } else {
    advice.from_crs = "EPSG:4326";
  }
  return warp_command(picture, advice);
}

}  // namespace terrella
