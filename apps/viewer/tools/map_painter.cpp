#include "apps/viewer/tools/map_painter.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "base/code_points.h"

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
const glm::vec3 kCountry(255.0F, 236.0F, 200.0F), kPlace(236.0F, 242.0F, 248.0F);

bool font_has(const std::string& text) {
  return std::ranges::all_of(code_points(text), [](char32_t letter) {
    return letter <= 0xFFFF && ImGui::GetFont()->FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr;
  });
}

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
      names_(std::move(data.names)),
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

// A name with a letter that no font has is written without marks, or left out. The next frame has the other letters.
void MapPainter::fit_to_fonts() {
  std::vector<std::string> texts;
  for (const MapName& name : names_) texts.push_back(panel_text(name.text));
  if (letters_wait()) return;
  std::vector<MapName> fitting;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    MapName& name = names_[k];
    name.text = font_has(texts[k]) ? std::move(texts[k]) : without_marks(name.text);
    if (font_has(name.text)) fitting.push_back(std::move(name));
  }
  names_ = {};
  labels_.emplace(std::move(fitting), ellipsoid_);
}

std::vector<UiBox> MapPainter::draw_names(const Globe& globe, const View& view, double unit_px, MapDetail detail,
                                          const std::vector<UiBox>& taken) {
  if (!labels_) fit_to_fonts();
  if (!labels_) return {};
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const Ground ground = globe.ground();
  const std::vector<EyePart> eyes = eye_parts(globe, view);
  LabelPage page{.moves = detail == MapDetail::in_motion,
                 .scale = unit_px * double(ImGui::GetFontSize() / kPlainText_px),
                 .size_px = [unit_px](const std::string& text) {
                   const ImVec2 size = ImGui::CalcTextSize(text.c_str());
                   return unit_px * glm::dvec2(size.x, size.y);
                 }};
  for (const UiBox& box : taken) {
    page.taken.push_back(
        {glm::vec2(glm::dvec2(box.left, box.top) * unit_px), glm::vec2(glm::dvec2(box.right, box.bottom) * unit_px)});
  }
  // Both eyes see the same names.
  const std::vector<ShownName> shown = labels_->place(eyes.front().view, ground, page);
  std::vector<UiBox> boxes;
  for (const auto& [eye, part] : eyes) {
    begin_part(list, part, unit_px);
    for (const ShownName& name : shown) {
      const MapName& what = labels_->names()[name.name];
      const auto px = labels_->place_px(name.name, eye, ground);
      if (!px) continue;
      const ImVec2 at = to_ui(glm::dvec2(part.left_px, 0) + *px, unit_px), text = to_ui(name.text_px, unit_px);
      if (!what.is_area) draw_dot(list, at);
      const ImVec2 from{std::round(at.x + text.x), std::round(at.y + text.y)};
      const ImVec2 size = ImGui::CalcTextSize(what.text.c_str());
      boxes.push_back({from.x, from.y, from.x + size.x, from.y + size.y});
      shaded_text(list, from, what.text.c_str(), ink(what.is_area ? kCountry : kPlace, 255),
                  detail == MapDetail::in_motion);
    }
    end_part(list);
  }
  return boxes;
}

}  // namespace terrella
