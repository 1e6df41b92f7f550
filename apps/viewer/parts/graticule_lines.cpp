#include "apps/viewer/parts/graticule_lines.h"

#include <imgui.h>

#include <algorithm>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/viewer/panels/panel_items.h"
#include "objects/graticule.h"
#include "view/stereo.h"

namespace terrella {
namespace {

const ImU32 kShade = IM_COL32(0, 0, 0, 210);  // around labels, which also stand on snow

ImU32 tinted(glm::vec3 color, const glm::vec3& tint, int alpha) {
  color *= tint;
  return IM_COL32(static_cast<int>(color.x), static_cast<int>(color.y), static_cast<int>(color.z), alpha);
}

void shaded_text(ImDrawList* list, ImVec2 at, const char* text, ImU32 ink) {
  for (const ImVec2 off : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1), ImVec2(1, 1), ImVec2(-1, -1),
                           ImVec2(1, -1), ImVec2(-1, 1)}) {
    list->AddText({at.x + off.x, at.y + off.y}, kShade, text);
  }
  list->AddText(at, ink, text);
}

ImVec2 to_ui(glm::dvec2 px, double unit_px) {
  return {static_cast<float>(px.x / unit_px), static_cast<float>(px.y / unit_px)};
}

void draw_label(ImDrawList* list, const GraticuleLabel& label, ImVec2 at, ImU32 ink, const std::vector<UiBox>& taken) {
  const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
  const ImVec2 from{at.x - static_cast<float>(label.anchor.x) * size.x,
                    at.y - static_cast<float>(label.anchor.y) * size.y};
  const UiBox box{from.x, from.y, from.x + size.x, from.y + size.y};
  if (std::ranges::any_of(taken, [&box](const UiBox& panel) { return panel.overlaps(box); })) return;
  shaded_text(list, from, label.text.c_str(), ink);
}

}  // namespace

void draw_graticule(const Graticule& graticule, const GraticulePart& part, double unit_px,
                    const std::vector<UiBox>& taken) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const glm::dvec2 corner(part.left_px, 0);
  list->PushClipRect(to_ui(corner, unit_px),
                     to_ui(corner + glm::dvec2(part.size.width_px, part.size.height_px), unit_px));
  std::vector<ImVec2> points;
  for (const GraticuleLine& line : graticule.lines) {
    points.clear();
    for (const glm::dvec2 px : line.points_px) points.push_back(to_ui(corner + px, unit_px));
    const glm::vec3 white(255.0F), amber(255.0F, 226.0F, 150.0F);
    const float alpha = line.strength * (line.principal ? 190.0F : 105.0F);
    const ImU32 colour = tinted(line.principal ? amber : white, part.tint, static_cast<int>(alpha));
    list->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0,
                      line_width(line.principal ? 1.6F : 1.0F));
  }
  for (const GraticuleLabel& label : graticule.labels) {
    draw_label(list, label, to_ui(corner + label.at_px, unit_px), tinted({232, 240, 248}, part.tint, 255), taken);
  }
  list->PopClipRect();
}

// Each eye gets its own lines; interlaced pictures have too few rows for two sets.
void GraticuleLines::draw_over(const View& view, double foot) const {
  if (!on_) return;
  const Ellipsoid& body = context_.globe.options().body.ellipsoid;
  const double unit_px = context_.window.pixels_per_unit().x, text_px = Ui::text_height() * unit_px;
  const LabelSize label{.character_px = 0.62 * text_px, .line_px = 1.2 * text_px, .foot_px = foot * unit_px};
  const std::vector<UiBox> taken = Ui::panel_boxes();
  const StereoLook& stereo = context_.globe.options().stereo;
  if (stereo.mode == Stereo::off || stereo.mode == Stereo::interlaced) {
    return draw_graticule(make_graticule(view, body, label), {.size = view.viewport}, unit_px, taken);
  }
  const bool halves = stereo.mode == Stereo::side_by_side;
  Viewport size = view.viewport;
  if (halves) size.width_px = std::max(1, size.width_px / 2);
  const EyePair eyes = stereo_eyes(context_.globe.view(size), body, stereo);
  GraticulePart left{.size = size}, right{.left_px = halves ? size.width_px : 0, .size = size};
  if (!halves) left.tint = {1.0F, 0.0F, 0.0F};
  if (!halves) right.tint = {0.0F, 1.0F, 1.0F};
  draw_graticule(make_graticule(eyes.left, body, label), left, unit_px, taken);
  draw_graticule(make_graticule(eyes.right, body, label), right, unit_px, taken);
}

}  // namespace terrella
