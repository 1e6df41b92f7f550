#include "objects/label_layout.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/code_points.h"

namespace terrella {
namespace {

constexpr int kCell_px = 64;
constexpr float kMarkerGap_px = 4.0F;  // gap between a marker and the text beside it
constexpr float kLineGap_px = 1.0F;    // the same over or under it, where the height of a line adds room to the letters
constexpr float kDiagonal = 0.7071068F;

}  // namespace

std::u32string label_text(std::string_view utf8) {
  std::u32string text = code_points(utf8);
  if (text.size() <= kMostLabelCharacters) return text;
  text.resize(kMostLabelCharacters);
  text.back() = U'…';
  return text;
}

TextWay text_way(TextAnchor anchor, float reach_px, float half_height_px) {
  const glm::vec2 side = 1.0F - 2.0F * part_at(anchor);
  const float beside_px = std::round(side.x != 0.0F && side.y != 0.0F ? kDiagonal * reach_px : reach_px);
  return {side.x * (beside_px + kMarkerGap_px), side.x, side.y * (beside_px + kLineGap_px + half_height_px)};
}

LabelRoom::LabelRoom(Viewport picture)
    : picture_(picture),
      columns_(picture.width_px / kCell_px + 1),
      rows_(picture.height_px / kCell_px + 1),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

/// Calls with the index of each cell that a box touches.
template <class Visit>
void LabelRoom::each_cell(const LabelBox& box, const Visit& visit) const {
  for (int row = int(box.low_px.y) / kCell_px; row <= int(box.high_px.y) / kCell_px; ++row) {
    for (int column = int(box.low_px.x) / kCell_px; column <= int(box.high_px.x) / kCell_px; ++column) {
      visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column));
    }
  }
}

void LabelRoom::claim(const LabelBox& box) {
  each_cell(box, [this, &box](std::size_t cell) { cells_[cell].push_back(box); });
}

bool LabelRoom::is_free(const LabelBox& box) const {
  if (!(box.low_px.x >= 0.0F && box.low_px.y >= 0.0F && box.high_px.x <= float(picture_.width_px) &&
        box.high_px.y <= float(picture_.height_px))) {
    return false;
  }
  bool free = true;
  each_cell(box, [this, &free, &box](std::size_t cell) {
    free = free && std::ranges::none_of(cells_[cell], [&box](const LabelBox& other) {
             return box.low_px.x < other.high_px.x && other.low_px.x < box.high_px.x &&
                    box.low_px.y < other.high_px.y && other.low_px.y < box.high_px.y;
           });
  });
  return free;
}

bool LabelRoom::take(const LabelBox& box) {
  if (!is_free(box)) return false;
  claim(box);
  return true;
}

bool is_behind(const glm::dvec3& point_m, const glm::dvec3& eye_m, const glm::dvec3& half_axes_m) {
  if (!(half_axes_m.x > 0.0 && half_axes_m.y > 0.0 && half_axes_m.z > 0.0)) return false;
  const glm::dvec3 eye = eye_m / half_axes_m, way = point_m / half_axes_m - eye;
  const double length2 = glm::dot(way, way);
  const double nearest = length2 > 0.0 ? std::clamp(-glm::dot(eye, way) / length2, 0.0, 1.0) : 0.0;
  const glm::dvec3 at = eye + nearest * way;
  return glm::dot(at, at) < 1.0;
}

bool is_beside_planet(const View& view, const Ellipsoid& planet, const glm::dvec2& pixel_px) {
  return !planet.intersect_m(view.eye, pixel_ray(view, pixel_px));
}

}  // namespace terrella
