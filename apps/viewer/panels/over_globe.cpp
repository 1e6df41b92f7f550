#include "apps/viewer/panels/over_globe.h"

#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>

#include "objects/object_pick.h"
#include "view/stereo.h"

namespace terrella {
namespace {

// Dear ImGui calls this in the order of the list's lines and texts. The list holds the channels as a pointer.
void write_channels(const ImDrawList*, const ImDrawCmd* command) {
  const auto channels = reinterpret_cast<std::uintptr_t>(command->UserCallbackData);
  glColorMask((channels & kRedChannel) != 0, (channels & kGreenChannel) != 0, (channels & kBlueChannel) != 0, GL_TRUE);
}

void limit_channels(ImDrawList* list, std::uintptr_t channels) {
  list->AddCallback(write_channels, reinterpret_cast<void*>(channels));
}

}  // namespace

std::vector<EyePart> eye_parts(const Globe& globe, const View& view) {
  const StereoLook& stereo = globe.options().stereo;
  if (stereo.mode == Stereo::off || stereo.mode == Stereo::interlaced) return {{view, {.size = view.viewport}}};
  const bool halves = stereo.mode == Stereo::side_by_side;
  Viewport size = view.viewport;
  if (halves) size.width_px = std::max(1, size.width_px / 2);
  const EyePair eyes = stereo_eyes(globe.view(size), globe.options().body.ellipsoid, stereo);
  PicturePart left{.size = size}, right{.left_px = halves ? size.width_px : 0, .size = size};
  if (!halves) left.channels = kRedChannel;
  if (!halves) right.channels = kGreenChannel | kBlueChannel;
  return {{eyes.left, left}, {eyes.right, right}};
}

bool is_hidden(const Globe& globe, const View& view, const Ecef& at) {
  const bool opaque = globe.options().surface.alpha >= 1.0;
  if (!opaque && glm::dot(at.xyz_m, at.xyz_m - view.eye.xyz_m) <= 0.0) return false;
  return hidden_by_ground(view, opaque ? globe.ground() : Ground(globe.options().body.ellipsoid), at);
}

std::vector<UiBox> object_labels(const Globe& globe, double unit_px) {
  const std::vector<UiBox> panels = Ui::panel_boxes();
  std::vector<UiBox> labels;
  for (const PictureBox& label : globe.label_boxes()) {
    const glm::dvec2 low = glm::dvec2(label.low_px) / unit_px, high = glm::dvec2(label.high_px) / unit_px;
    const UiBox box{low.x, low.y, high.x, high.y};
    if (std::ranges::none_of(panels, [&box](const UiBox& panel) { return panel.overlaps(box); })) labels.push_back(box);
  }
  return labels;
}

ImVec2 to_ui(glm::dvec2 px, double unit_px) {
  return {static_cast<float>(px.x / unit_px), static_cast<float>(px.y / unit_px)};
}

unsigned ink(const glm::vec3& color, int alpha) {
  return IM_COL32(static_cast<int>(color.x), static_cast<int>(color.y), static_cast<int>(color.z), alpha);
}

void shaded_text(ImDrawList* list, ImVec2 at, const char* text, unsigned ink) {
  constexpr ImU32 kShade = IM_COL32(0, 0, 0, 210);
  static const ImVec2 kOffsets[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
  for (const ImVec2 off : kOffsets) list->AddText({at.x + off.x, at.y + off.y}, kShade, text);
  list->AddText(at, ink, text);
}

void begin_part(ImDrawList* list, const PicturePart& part, double unit_px) {
  const glm::dvec2 corner(part.left_px, 0);
  list->PushClipRect(to_ui(corner, unit_px),
                     to_ui(corner + glm::dvec2(part.size.width_px, part.size.height_px), unit_px));
  limit_channels(list, part.channels);
}

void end_part(ImDrawList* list) {
  limit_channels(list, kAllChannels);
  list->PopClipRect();
}

}  // namespace terrella
