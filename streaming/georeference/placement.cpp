#include "streaming/georeference/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "streaming/georeference/crs_text.h"
#include "streaming/georeference/gdal_advice.h"
#include "streaming/georeference/warp_extent.h"
#include "streaming/raster/raster_file.h"

namespace terrella {
namespace {

constexpr double kPlaced_px = 0.01;
constexpr int kProbes = 17;  ///< pixel corners transformed along each side; projections are smooth between them
/// Largest plausible longitude: an extra turn.
constexpr double kMostLongitude_deg = 540.0;
/// Largest plausible latitude of numbers without a system: half a pixel of a coarse picture beyond the pole.
constexpr double kMostLatitude_deg = 100.0;
/// Largest plausible distance beyond a pole: a pixel, or this angle.
constexpr double kBeyondPole_deg = 0.1;
constexpr double kBeyondPole_px = 1.01;

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

/// True if the place is not further beyond the poles, or round the planet, than edges of pixels may be.
bool is_plausible(const PictureFile& picture, const Placement& place) {
  const double beyond = std::max(kBeyondPole_deg, kBeyondPole_px * place.pixel_height_deg);
  const double south = place.north_deg - static_cast<double>(picture.height_px) * place.pixel_height_deg;
  const double wide = static_cast<double>(picture.width_px) * place.pixel_width_deg;
  return std::abs(place.west_deg) <= kMostLongitude_deg && wide <= kMostLongitude_deg &&
         place.north_deg <= 90.0 + beyond && south >= -90.0 - beyond;
}

Error implausible(const PictureFile& picture, const std::string& claim, const Placement& place) {
  return Error{fmt::format(
      "{} put it at longitudes {:.9g} to {:.9g} and latitudes {:.9g} to {:.9g}, which is more than a planet has; say "
      "what is right with ‹crs› CRS or ‹bounds› W,S,E,N, or write it into a copy: {}",
      claim, place.west_deg, place.west_deg + static_cast<double>(picture.width_px) * place.pixel_width_deg,
      place.north_deg - static_cast<double>(picture.height_px) * place.pixel_height_deg, place.north_deg,
      assign_command(picture))};
}

Affine in_degrees(const Placement& place) {
  return {place.west_deg, place.pixel_width_deg, 0.0, place.north_deg, 0.0, -place.pixel_height_deg};
}

/// Place without a coordinate system. Numbers count as degrees if possible.
Result<Placement> place_without_crs(const PictureFile& picture, const Georeference& said) {
  const Affine& t = *said.transform;
  const bool plain = !t.is_turned() && t.x_per_column > 0.0 && t.y_per_row < 0.0;
  if (plain && are_degrees(t, picture)) {
    const Placement place{
        .west_deg = t.x0, .north_deg = t.y0, .pixel_width_deg = t.x_per_column, .pixel_height_deg = -t.y_per_row};
    if (is_plausible(picture, place)) return place;
    return implausible(picture, claim_text(picture, said, {}), place);
  }
  return Error{fmt::format(
      "{} put its corner at ({:.9g}, {:.9g}) with pixels of {:.6g} by {:.6g}{}, which are no degrees from the "
      "north-west, and name no coordinate system; say which with ‹crs› and the code that the picture's source gives, "
      "as ‹crs› EPSG:32633, or write it into a copy: {}",
      claim_text(picture, said, {}), t.x0, t.y0, std::hypot(t.x_per_column, t.y_per_column),
      std::hypot(t.x_per_row, t.y_per_row), t.is_turned() ? ", turned" : "", name_system_command(picture))};
}

/// Error for control points beside a picture.
Error points_alone(const PictureFile& picture, const Georeference& said, const std::string& to_crs) {
  return Error{fmt::format("{}: its {} place it by ground control points, not by a grid; resample it: {}",
                           picture.path.string(), said.source,
                           warp_command(picture, {.to_crs = to_crs, .from_crs = said.crs.empty() ? "EPSG:CODE" : ""}))};
}

/// A picture while its place is being found.
struct Case {
  const PictureFile& picture;
  const PlaceWords& words;
  Georeference said{};  ///< after the user's words
  PlacedPicture placed{};
};

/// Statement of the user or the picture about the system, as the beginning of a message.
std::string case_text(const Case& of, const CrsFacts& facts) {
  if (of.words.crs.empty()) return claim_text(of.picture, of.said, facts);
  return fmt::format("{}: ‹crs› says that it is {} ({})", of.picture.path.string(),
                     facts.geographic ? "geographic" : "projected", crs_text(facts, {}));
}

/// Place of a transform in a known system.
Status place_transform(Case& of, const Crs& crs) {
  const auto places = crs.places(probes(of.picture, *of.said.transform));
  if (!places) return Error{fmt::format("{}: {}", of.picture.path.string(), places.error().message)};
  of.placed.projected = CrsPlace{*of.said.transform, of.said.crs};
  of.placed.placement = evenly_spaced(*places, of.picture);
  if (auto& place = of.placed.placement) {
    if (!crs.facts().geographic) begin_in_first_turn(*place);
    if (!is_plausible(of.picture, *place)) return implausible(of.picture, case_text(of, crs.facts()) + ", and", *place);
    return Done{};
  }
  const bool fits = !crs.facts().geographic || are_degrees(*of.said.transform, of.picture);  // even if turned
  if (fits && warp_extent(of.picture, of.said, crs)) return Done{};
  return Error{fmt::format(
      "{}, and {} by that; say what is right with ‹crs› CRS or ‹bounds› W,S,E,N, or write it into a copy: {}",
      case_text(of, crs.facts()),
      fits ? "no pixel of it has a place on the planet" : "its corners are at more than a planet has",
      assign_command(of.picture))};
}

/// Place that the user gives in degrees.
Status place_by_words(Case& of, const Crs* crs) {
  const auto place = place_of_words(of.picture, of.words);
  if (!place) return place.error();
  of.placed.placement = *place;
  of.placed.projected = CrsPlace{in_degrees(*place), crs != nullptr ? crs->degrees_text() : "EPSG:4326"};
  return Done{};
}

/// Place in a known coordinate system.
Status place_in(Case& of, const Crs& crs) {
  of.placed.crs = crs.facts();
  of.placed.claim = case_text(of, crs.facts());
  if (of.words.west_deg || (of.words.bounds && of.words.crs.empty())) return place_by_words(of, &crs);
  if (const auto& b = of.words.bounds) {
    const auto width = static_cast<double>(of.picture.width_px), height = static_cast<double>(of.picture.height_px);
    of.said.transform =
        Affine{b->west, (b->east - b->west) / width, 0.0, b->north, 0.0, (b->south - b->north) / height};
  } else if (of.said.has_control_points) {
    return points_alone(of.picture, of.said, crs.degrees_text());
  }
  if (of.said.transform) return place_transform(of, crs);
  if (crs.facts().geographic) return Done{};
  return Error{
      fmt::format("{}, and not where; say it with ‹bounds› W,S,E,N in its units and ‹crs›, or write it into a "
                  "copy: {}",
                  case_text(of, crs.facts()), assign_command(of.picture))};
}

/// Place without any coordinate system.
Status place_nowhere_named(Case& of) {
  if (of.words.say_place()) return place_by_words(of, nullptr);
  if (of.said.has_control_points) return points_alone(of.picture, of.said, "EPSG:4326");
  if (!of.said.transform) return Done{};
  const auto place = place_without_crs(of.picture, of.said);
  if (!place) return place.error();
  of.placed.placement = *place;
  of.placed.projected = CrsPlace{*of.said.transform, "EPSG:4326"};
  of.placed.remarks.push_back(claim_text(of.picture, of.said, {}) +
                              " name no coordinate system; its numbers are taken for degrees");
  return Done{};
}

/// Notes statements of the picture that the user's words overrule.
void remark_on(Case& of, const Crs* crs) {
  const auto& said = of.placed.said;
  const std::string name = of.picture.path.string();
  if (!said) return;
  if (!of.words.crs.empty() && !said->crs.empty() && crs != nullptr) {
    const auto stated = Crs::open(said->crs);
    if (!stated || !stated->is_same_as(*crs)) {
      of.placed.remarks.push_back(
          fmt::format("{}; ‹crs› ({}) is used instead",
                      stated ? claim_text(of.picture, *said, stated->facts())
                             : fmt::format("{}: its {} name a system that is not known", name, said->source),
                      crs_text(crs->facts(), {})));
    }
  }
  if (of.words.say_place() && (said->transform || said->has_control_points)) {
    of.placed.remarks.push_back(fmt::format("{}: its {} state a place; {} is used instead", name, said->source,
                                            of.words.bounds ? "‹bounds›" : "‹west_deg›"));
  }
}

/// Reads the picture's statement. Damage that the user's words make good becomes a remark.
Status read_said(Case& of) {
  auto said = read_georeference(of.picture);
  if (!said) {
    const Error damage = said.error();
    if (!of.words.crs.empty()) said = read_georeference(of.picture, false);
    if (!said && !of.words.say_place()) return said.error();
    if (!said) said = std::optional<Georeference>{};
    const std::string& why = damage.message;
    of.placed.remarks.push_back(why.substr(0, why.find(", so where")) + "; the options are used instead");
  }
  of.placed.said = *std::move(said);
  of.said = of.placed.said.value_or(Georeference{});
  if (of.words.crs.empty()) return Done{};
  // PROJ strings need "+type=crs". Texts that name files of shifts are the user's own affair.
  const auto text = stated_crs(of.words.crs);
  of.said.crs = text ? *text : of.words.crs;
  return Done{};
}

}  // namespace

Result<Placement> place_of_words(const PictureFile& picture, const PlaceWords& words) {
  const auto width = static_cast<double>(picture.width_px), height = static_cast<double>(picture.height_px);
  CrsBounds at = words.bounds.value_or(CrsBounds{});
  if (words.west_deg) {
    if (std::abs(picture.width_px - 2 * picture.height_px) > 1) {
      return Error{
          fmt::format("{}: {}x{} pixels are not 2:1, and ‹west_deg› is for a picture of a whole planet; say where "
                      "it lies with ‹bounds› W,S,E,N",
                      picture.path.string(), picture.width_px, picture.height_px)};
    }
    at = {*words.west_deg, -90.0, *words.west_deg + 360.0, 90.0};
  }
  if (at.east < at.west) at.east += 360.0;
  return Placement{.west_deg = at.west,
                   .north_deg = at.north,
                   .pixel_width_deg = (at.east - at.west) / width,
                   .pixel_height_deg = (at.north - at.south) / height};
}

Result<PlacedPicture> place_picture(const PictureFile& picture, const PlaceWords& words) {
  Case of{.picture = picture, .words = words};
  if (picture.raster) of.placed.remarks = picture.raster->header().remarks;
  if (Status read = read_said(of); !read) return read.error();
  if (of.said.crs.empty()) {
    remark_on(of, nullptr);
    if (Status placed = place_nowhere_named(of); !placed) return placed.error();
    return std::move(of.placed);
  }
  const auto crs = Crs::open(of.said.crs);
  if (!crs) {
    if (!words.crs.empty()) {
      return Error{
          fmt::format("{}: ‹crs› {}: this is no coordinate system that PROJ knows; give a code as EPSG:32633, "
                      "a PROJ string or WKT",
                      picture.path.string(), words.crs)};
    }
    if (words.say_place()) {
      remark_on(of, nullptr);
      if (Status placed = place_by_words(of, nullptr); !placed) return placed.error();
      return std::move(of.placed);
    }
    return Error{fmt::format("{}: its {}: {}; say what is right with ‹crs› CRS, or write it into a copy: {}",
                             picture.path.string(), of.said.source, crs.error().message, assign_command(picture))};
  }
  remark_on(of, &*crs);
  if (Status placed = place_in(of, *crs); !placed) return placed.error();
  return std::move(of.placed);
}

}  // namespace terrella
