#include "apps/viewer/tools/map_painter.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr double kErrorInMotion_px = 2.0;
constexpr double kError_px = 0.5;       // largest error of lines at rest
constexpr float kPlainText_px = 15.0F;  // text height at 96 dots per inch
constexpr float kDot_px = 2.5F;         // radius of a place's dot
constexpr float kLine_px = 1.0F, kEdge_px = 3.0F;
constexpr double kEdgeAlpha = 75.0, kCoastAlpha = 170.0, kBorderAlpha = 190.0;
// Lines fade where a pixel covers more metres than this, so that they do not cover a small globe.
constexpr double kFull_m = 1.2e4;
constexpr double kLeastStrength = 0.3;
// Lines turn at most so far at a corner; sharper corners would get spikes.
constexpr float kLeastCosine = -0.2F;

const glm::vec3 kEdge(8.0F, 14.0F, 24.0F);
const glm::vec3 kCoast(196.0F, 222.0F, 240.0F), kBorder(255.0F, 224.0F, 170.0F);
const glm::vec3 kPlace(236.0F, 242.0F, 248.0F);

double strength_at(double m_per_px) { return std::clamp(kFull_m / std::max(m_per_px, 1.0), kLeastStrength, 1.0); }

/// Draws a line in runs without sharp corners.
void draw_line(ImDrawList* list, const std::vector<ImVec2>& points, ImU32 color, float width) {
  std::size_t from = 0;
  const auto way = [&points](std::size_t k) {
    const glm::vec2 step(points[k + 1].x - points[k].x, points[k + 1].y - points[k].y);
    const float length = glm::length(step);
    return length > 0.0F ? step / length : glm::vec2(1.0F, 0.0F);
  };
  for (std::size_t k = 1; k < points.size(); ++k) {
    const bool last = k + 1 == points.size();
    if (!last && glm::dot(way(k - 1), way(k)) > kLeastCosine) continue;
    list->AddPolyline(&points[from], static_cast<int>(k - from + 1), color, 0, width);
    from = k;
  }
}

void draw_dot(ImDrawList* list, ImVec2 at) {
  const float radius = line_width(kDot_px);
  list->AddCircleFilled(at, radius + line_width(1.0F), ink(kEdge, 200), 12);
  list->AddCircleFilled(at, radius, ink(kPlace, 255), 12);
}

}  // namespace

MapPainter::MapPainter(MapData data, const Ellipsoid& ellipsoid)
    : ellipsoid_(ellipsoid),
      lines_(data.lines, ellipsoid),
      labels_(std::move(data.names), ellipsoid),
      font_(std::move(data.font)),
      attributions_(std::move(data.attributions)) {}

void MapPainter::draw_lines(const Globe& globe, const View& view, double unit_px, MapDetail detail) const {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const Ground ground = globe.ground();
  const bool moves = detail == MapDetail::in_motion;
  for (const auto& [eye, part] : eye_parts(globe, view)) {
    begin_part(list, part, unit_px);
    std::vector<std::pair<MapLineKind, std::vector<ImVec2>>> lines;
    for (const MapPiece& piece : lines_.trace(eye, ground, moves ? kErrorInMotion_px : kError_px)) {
      std::vector<ImVec2> points;
      points.reserve(piece.points_px.size());
      for (const glm::dvec2 px : piece.points_px) points.push_back(to_ui(glm::dvec2(part.left_px, 0) + px, unit_px));
      lines.emplace_back(piece.kind, std::move(points));
    }
    const double strength = strength_at(ellipsoid_.to_geodetic(eye.eye).height_m / eye.pixels_per_radian());
    const ImU32 edge = ink(kEdge, int(strength * kEdgeAlpha));
    for (const auto& line : lines) {
      if (!moves) draw_line(list, line.second, edge, line_width(kEdge_px));
    }
    const ImU32 coast = ink(kCoast, int(strength * kCoastAlpha));
    const ImU32 border = ink(kBorder, int(strength * kBorderAlpha));
    for (const auto& [kind, points] : lines)
      draw_line(list, points, kind == MapLineKind::coast ? coast : border, line_width(kLine_px));
    end_part(list);
  }
}

std::vector<UiBox> MapPainter::draw_names(const Globe& globe, const View& view, double unit_px, MapDetail detail,
                                          const std::vector<UiBox>& taken) {
  if (!texts_) texts_ = MapTexts::create(std::exchange(font_, {}));
  if (!texts_) return {};
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const Ground ground = globe.ground();
  const std::vector<EyePart> eyes = eye_parts(globe, view);
  const double scale = unit_px * double(ImGui::GetFontSize() / kPlainText_px);
  LabelPage page{.moves = detail == MapDetail::in_motion,
                 .scale = scale,
                 .size_px = [this, scale](const MapName& name) { return texts_->size_px(name, scale); }};
  for (const UiBox& box : taken) {
    page.taken.push_back(
        {glm::vec2(glm::dvec2(box.left, box.top) * unit_px), glm::vec2(glm::dvec2(box.right, box.bottom) * unit_px)});
  }
  // Both eyes see the same names.
  std::vector<ShownName> shown;
  bool again = false;
  texts_->with_room([&] {
    if (std::exchange(again, true)) labels_.take_back();
    shown = labels_.place(eyes.front().view, ground, page);
  });
  std::vector<UiBox> boxes;
  for (const auto& [eye, part] : eyes) {
    begin_part(list, part, unit_px);
    std::vector<MapText> texts;
    for (const ShownName& name : shown) {
      const MapName& what = labels_.names()[name.name];
      const auto px = labels_.place_px(name.name, eye, ground);
      if (!px) continue;
      const glm::dvec2 at = glm::dvec2(part.left_px, 0) + *px, low = glm::round(at + name.text_px);
      if (!what.is_area) draw_dot(list, to_ui(at, unit_px));
      const glm::dvec2 from = low / unit_px, to = (low + page.size_px(what)) / unit_px;
      boxes.push_back({from.x, from.y, to.x, to.y});
      texts.push_back({&what, low});
    }
    texts_->draw(list, texts, scale, unit_px);
    end_part(list);
  }
  return boxes;
}

}  // namespace terrella
