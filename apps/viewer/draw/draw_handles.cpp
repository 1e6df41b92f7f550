#include "apps/viewer/draw/draw_handles.h"

#include <imgui.h>

#include <glm/geometric.hpp>

#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr std::size_t kMostHandles = 500;
constexpr double kApart_px = 20.0;  // from a place to the handle in the middle
constexpr float kHalfSide = 4.0F;   // at 96 dots per inch
const ImU32 kHandleInk = IM_COL32(255, 255, 255, 255), kHandleEdge = IM_COL32(0, 0, 0, 200),
            kHandleChosen = IM_COL32(255, 214, 64, 255);

std::optional<glm::dvec2> shown_px(const Globe& globe, const View& view, const Geodetic& place) {
  const auto px = project(view, globe.ground(), place.lat, place.lon);
  if (!px || px->x < 0.0 || px->y < 0.0 || px->x > view.viewport.width_px || px->y > view.viewport.height_px) return {};
  const double height_m = globe.ground_height_m(place.lat, place.lon);
  const Ecef at = globe.options().body.ellipsoid.to_ecef({place.lat, place.lon, height_m});
  return is_hidden(globe, view, at) ? std::nullopt : px;
}

}  // namespace

std::vector<MarkHandle> mark_handles(const Globe& globe, const View& view, const DrawnMark& mark) {
  std::vector<MarkHandle> handles;
  for (std::size_t k = 0; k < mark.places.size() && handles.size() < kMostHandles; ++k) {
    const Geodetic& place = mark.places[k];
    if (const auto px = shown_px(globe, view, place)) handles.push_back({k, place, *px});
  }
  if (mark.places.size() < 2) return handles;
  const Geodetic middle = middle_of(mark);
  auto px = shown_px(globe, view, middle);
  if (!px) return handles;
  if (handle_at(handles, *px, kApart_px) != nullptr) px->y += kApart_px;
  handles.push_back({std::nullopt, middle, *px});
  return handles;
}

const MarkHandle* handle_at(std::span<const MarkHandle> handles, glm::dvec2 at_px, double reach_px) {
  const MarkHandle* nearest = nullptr;
  for (const MarkHandle& handle : handles) {
    const double distance_px = glm::distance(handle.at_px, at_px);
    if (distance_px > reach_px) continue;
    if (nearest == nullptr || distance_px < glm::distance(nearest->at_px, at_px)) nearest = &handle;
  }
  return nearest;
}

void draw_handles(std::span<const MarkHandle> handles, std::size_t chosen, double unit_px) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const float half = line_width(kHalfSide), edge = line_width(1.5F);
  for (const MarkHandle& handle : handles) {
    const ImVec2 at = to_ui(handle.at_px, unit_px);
    if (handle.place) {
      const ImVec2 low{at.x - half, at.y - half}, high{at.x + half, at.y + half};
      list->AddRectFilled(low, high, *handle.place == chosen ? kHandleChosen : kHandleInk);
      list->AddRect(low, high, kHandleEdge, 0.0F, 0, edge);
    } else {
      const float far = 1.7F * half;
      const ImVec2 left{at.x - far, at.y}, right{at.x + far, at.y}, up{at.x, at.y - far}, down{at.x, at.y + far};
      list->AddQuadFilled(left, up, right, down, kHandleInk);
      list->AddQuad(left, up, right, down, kHandleEdge, edge);
    }
  }
}

}  // namespace terrella
