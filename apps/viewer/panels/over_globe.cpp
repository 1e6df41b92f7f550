#include "apps/viewer/panels/over_globe.h"

#include <imgui.h>

#include <algorithm>
#include <span>

#include "view/stereo.h"

namespace terrella {

std::vector<EyePart> eye_parts(const Globe& globe, const View& view) {
  const StereoLook& stereo = globe.options().stereo;
  if (stereo.mode == Stereo::off || stereo.mode == Stereo::interlaced) return {{view, {.size = view.viewport}}};
  const bool halves = stereo.mode == Stereo::side_by_side;
  Viewport size = view.viewport;
  if (halves) size.width_px = std::max(1, size.width_px / 2);
  const EyePair eyes = stereo_eyes(globe.view(size), globe.options().body.ellipsoid, stereo);
  PicturePart left{.size = size}, right{.left_px = halves ? size.width_px : 0, .size = size};
  if (!halves) left.tint = {1.0F, 0.0F, 0.0F};
  if (!halves) right.tint = {0.0F, 1.0F, 1.0F};
  return {{eyes.left, left}, {eyes.right, right}};
}

ImVec2 to_ui(glm::dvec2 px, double unit_px) {
  return {static_cast<float>(px.x / unit_px), static_cast<float>(px.y / unit_px)};
}

unsigned tinted(glm::vec3 color, const glm::vec3& tint, int alpha) {
  color *= tint;
  return IM_COL32(static_cast<int>(color.x), static_cast<int>(color.y), static_cast<int>(color.z), alpha);
}

void shaded_text(ImDrawList* list, ImVec2 at, const char* text, unsigned ink, bool thin) {
  constexpr ImU32 kShade = IM_COL32(0, 0, 0, 210);
  static const ImVec2 kThick[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
  for (const ImVec2 off : std::span(kThick).first(thin ? 4 : 8)) {
    list->AddText({at.x + off.x, at.y + off.y}, kShade, text);
  }
  list->AddText(at, ink, text);
}

void push_clip(ImDrawList* list, const PicturePart& part, double unit_px) {
  const glm::dvec2 corner(part.left_px, 0);
  list->PushClipRect(to_ui(corner, unit_px),
                     to_ui(corner + glm::dvec2(part.size.width_px, part.size.height_px), unit_px));
}

}  // namespace terrella
