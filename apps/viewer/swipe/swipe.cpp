#include "apps/viewer/swipe/swipe.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/panels/panel_items.h"
#include "surface/layers.h"

namespace terrella {
namespace {

constexpr double kReach_px = 8.0;                     // at 96 dots per inch, from the line to the mouse
constexpr float kHandleRadius = 9.0F, kArrow = 4.0F;  // at 96 dots per inch
const ImU32 kLineInk = IM_COL32(255, 255, 255, 235), kLineEdge = IM_COL32(0, 0, 0, 140),
            kArrowInk = IM_COL32(20, 28, 38, 255);

}  // namespace

void Swipe::show(bool on) {
  SurfaceLook surface = context_.globe.options().surface;
  if (surface.swipe) place_ = *surface.swipe;
  surface.swipe = on ? std::optional(place_) : std::nullopt;
  context_.globe.set_surface(surface);
}

void Swipe::move_to(double place) {
  SurfaceLook surface = context_.globe.options().surface;
  surface.swipe = std::clamp(place, 0.0, 1.0);
  context_.globe.set_surface(surface);
}

bool Swipe::drag(DragStep step, glm::dvec2 at_px) {
  const double width_px = context_.window.framebuffer().width_px;
  const auto line = context_.globe.options().surface.swipe;
  if (step == DragStep::begin) {
    held_ = line && std::abs(*line * width_px - at_px.x) <= kReach_px * double(context_.window.text_scale());
    return held_;
  }
  if (!held_) return false;
  if (step == DragStep::move && line) move_to(at_px.x / width_px);
  if (step == DragStep::end) held_ = false;
  return true;
}

void Swipe::draw_over(const View& view) const {
  const auto line = context_.globe.options().surface.swipe;
  if (!line) return;
  const double unit_px = context_.window.pixels_per_unit().x;
  const glm::dvec2 size_px(view.viewport.width_px, view.viewport.height_px);
  const double x_px = swipe_px(*line, view.viewport.width_px);
  const ImVec2 top = to_ui({x_px, 0.0}, unit_px), foot = to_ui({x_px, size_px.y}, unit_px),
               at = to_ui({x_px, 0.5 * size_px.y}, unit_px);
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  list->AddLine(top, foot, kLineEdge, line_width(4.0F));
  list->AddLine(top, foot, kLineInk, line_width(2.0F));
  const float radius = line_width(kHandleRadius), arrow = line_width(kArrow), gap = line_width(2.0F);
  list->AddCircleFilled(at, radius + line_width(1.0F), kLineEdge);
  list->AddCircleFilled(at, radius, kLineInk);
  for (const float side : {-1.0F, 1.0F}) {
    const float base = at.x + side * gap;
    list->AddTriangleFilled({base + side * arrow, at.y}, {base, at.y - arrow}, {base, at.y + arrow}, kArrowInk);
  }
}

}  // namespace terrella
