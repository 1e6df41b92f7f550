#include "objects/map_labels.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <tuple>
#include <utility>

namespace terrella {
namespace {

using glm::dvec2, glm::dvec3;

constexpr double kSteepest = 0.12;  // sine of the angle at which ground with names is seen, at least
constexpr double kPicturePerName_px = 15000.0;
constexpr double kGap_px = 6.0;        // between a dot and its text
constexpr double kDot_px = 3.5;        // radius
constexpr double kMargin_px = 3.0;     // around a text
constexpr double kNewMargin_px = 9.0;  // around a text that was not in the last picture
constexpr std::uint8_t kWait = 40;     // pictures
constexpr double kKept = 1.25;         // advantage of a name that was in the last picture

/// The part of a box in the picture; none if there is none.
std::optional<LabelBox> in_picture(const LabelBox& box, Viewport picture) {
  const glm::vec2 size(picture.width_px, picture.height_px);
  const LabelBox part{glm::max(box.low_px, glm::vec2(0.0F)), glm::min(box.high_px, size)};
  if (glm::any(glm::greaterThanEqual(part.low_px, part.high_px))) return {};
  return part;
}

}  // namespace

MapLabels::MapLabels(std::vector<MapName> names, const Ellipsoid& ellipsoid)
    : ellipsoid_(ellipsoid), names_(std::move(names)), shown_(names_.size(), Side::hidden), wait_(names_.size(), 0) {
  for (const MapName& name : names_) {
    normals_.push_back(Ellipsoid::normal(name.place.lat, name.place.lon));
    places_.push_back(ellipsoid.position(normals_.back()));
  }
}

std::optional<dvec2> MapLabels::place_px(std::size_t name, const View& view, const Ground& ground) const {
  const Geodetic& place = names_[name].place;
  const double height_m = ground.has_relief() ? ground.height_m(place.lat, place.lon) : 0.0;
  return project(view, Ecef{places_[name].xyz_m + height_m * normals_[name].xyz});
}

/// Names in the picture that are large enough, the highest rank first.
std::vector<MapLabels::Candidate> MapLabels::candidates(const View& view, const Ground& ground, double scale) const {
  std::vector<Candidate> found;
  const double metres = scale / view.pixels_per_radian();  // size of a pixel at a distance of one metre
  const double nearest_m = std::max(ellipsoid_.to_geodetic(view.eye).height_m * 0.9 - 2.0e4, 1.0);
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const double kept = shown_[k] == Side::hidden ? 1.0 : kKept;
    if (names_[k].widest_m * kept < nearest_m * metres) continue;
    const dvec3 to_eye = view.eye.xyz_m - places_[k].xyz_m;
    const double distance_m = glm::length(to_eye);
    // Ground at a grazing angle is foreshortened, which makes names denser.
    const double steepness = glm::dot(to_eye, normals_[k].xyz) / distance_m;
    if (steepness * kept < kSteepest) continue;
    if (names_[k].widest_m * kept * std::sqrt(steepness) < distance_m * metres) continue;
    const auto px = place_px(k, view, ground);
    if (!px || px->x < 0.0 || px->y < 0.0 || px->x > view.viewport.width_px || px->y > view.viewport.height_px)
      continue;
    found.push_back({k, names_[k].rank * kept, *px});
  }
  std::ranges::sort(found, [](const Candidate& a, const Candidate& b) {
    return a.rank != b.rank ? a.rank > b.rank : a.name < b.name;
  });
  return found;
}

/// Sides of a dot on which its text may stand, that of the last picture first.
std::vector<MapLabels::Side> MapLabels::sides(std::size_t name) const {
  if (names_[name].is_area) return {Side::middle};
  if (shown_[name] == Side::left) return {Side::left, Side::right};
  return {Side::right, Side::left};
}

void MapLabels::apart(const std::function<void()>& draw) {
  const std::vector<Side> shown = std::exchange(shown_, std::vector<Side>(names_.size(), Side::hidden));
  const std::vector<std::uint8_t> wait = std::exchange(wait_, std::vector<std::uint8_t>(names_.size()));
  draw();
  shown_ = shown;
  wait_ = wait;
}

void MapLabels::take_back() { std::tie(shown_, wait_) = std::move(before_); }

std::vector<ShownName> MapLabels::place(const View& view, const Ground& ground, const LabelPage& page) {
  LabelRoom room(view.viewport);
  for (const LabelBox& box : page.taken) {
    if (const auto part = in_picture(box, view.viewport)) room.claim(*part);
  }
  const double pixels = double(view.viewport.width_px) * view.viewport.height_px / (page.scale * page.scale);
  const auto most = static_cast<std::size_t>(std::ceil(pixels / kPicturePerName_px));
  std::vector<ShownName> shown;
  std::vector<Side> now(names_.size(), Side::hidden);
  for (const Candidate& candidate : candidates(view, ground, page.scale)) {
    if (shown.size() >= most) break;
    if (page.moves && wait_[candidate.name] > 0) continue;
    const dvec2 size = page.size_px(names_[candidate.name]);
    if (size.x <= 0.0) continue;
    const bool is_new = shown_[candidate.name] == Side::hidden;
    const glm::vec2 margin(dvec2(page.scale * (is_new ? kNewMargin_px : kMargin_px)));
    for (const Side side : sides(candidate.name)) {
      dvec2 text = -0.5 * size;
      if (side == Side::right) text.x = page.scale * kGap_px;
      if (side == Side::left) text.x = -page.scale * kGap_px - size.x;
      const dvec2 low = candidate.px + text, dot(side == Side::middle ? 0.0 : page.scale * kDot_px);
      const LabelBox box{glm::min(glm::vec2(low) - margin, glm::vec2(candidate.px - dot)),
                         glm::max(glm::vec2(low + size) + margin, glm::vec2(candidate.px + dot))};
      const dvec2 begin = low + dvec2(0.0, 0.5 * size.y);
      if (is_beside_planet(view, ellipsoid_, begin) || is_beside_planet(view, ellipsoid_, begin + dvec2(size.x, 0.0)))
        continue;
      if (!room.take(box)) continue;
      shown.push_back({candidate.name, candidate.px, text});
      now[candidate.name] = side;
      break;
    }
  }
  before_ = {shown_, wait_};
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (wait_[k] > 0) --wait_[k];
    if (now[k] == Side::hidden && shown_[k] != Side::hidden) wait_[k] = kWait;
  }
  shown_ = std::move(now);
  return shown;
}

}  // namespace terrella
