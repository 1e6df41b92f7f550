#include "apps/viewer/parts/graticule_lines.h"

#include <imgui.h>

#include <algorithm>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/viewer/panels/panel_items.h"
#include "objects/graticule.h"

namespace terrella {
namespace {

UiBox box_of(const GraticuleLabel& label, ImVec2 at) {
  const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
  const ImVec2 from{at.x - static_cast<float>(label.anchor.x) * size.x,
                    at.y - static_cast<float>(label.anchor.y) * size.y};
  return {from.x, from.y, from.x + size.x, from.y + size.y};
}

}  // namespace

std::vector<UiBox> draw_graticule(const Graticule& graticule, const PicturePart& part, double unit_px,
                                  const std::vector<UiBox>& taken) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const glm::dvec2 corner(part.left_px, 0);
  begin_part(list, part, unit_px);
  std::vector<ImVec2> points;
  for (const GraticuleLine& line : graticule.lines) {
    points.clear();
    for (const glm::dvec2 px : line.points_px) points.push_back(to_ui(corner + px, unit_px));
    const glm::vec3 white(255.0F), amber(255.0F, 226.0F, 150.0F);
    const float alpha = line.strength * (line.principal ? 190.0F : 105.0F);
    const ImU32 colour = ink(line.principal ? amber : white, static_cast<int>(alpha));
    list->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0,
                      line_width(line.principal ? 1.6F : 1.0F));
  }
  std::vector<UiBox> boxes;
  for (const GraticuleLabel& label : graticule.labels) {
    const UiBox box = box_of(label, to_ui(corner + label.at_px, unit_px));
    if (std::ranges::any_of(taken, [&box](const UiBox& panel) { return panel.overlaps(box); })) continue;
    boxes.push_back(box);
    shaded_text(list, {static_cast<float>(box.left), static_cast<float>(box.top)}, label.text.c_str(),
                ink({232, 240, 248}, 255));
  }
  end_part(list);
  return boxes;
}

std::vector<UiBox> GraticuleLines::draw_over(const View& view, double foot, const std::vector<UiBox>& taken) const {
  if (!on_) return {};
  return draw_graticule(context_.globe, view, context_.window.pixels_per_unit().x, foot, taken);
}

std::vector<UiBox> draw_graticule(const Globe& globe, const View& view, double unit_px, double foot,
                                  const std::vector<UiBox>& taken) {
  std::vector<UiBox> boxes;
  const Ellipsoid& body = globe.options().body.ellipsoid;
  const double text_px = Ui::text_height() * unit_px;
  const LabelSize label{.character_px = 0.62 * text_px, .line_px = 1.2 * text_px, .foot_px = foot * unit_px};
  for (const auto& [eye, part] : eye_parts(globe, view)) {
    const auto drawn = draw_graticule(make_graticule(eye, body, label), part, unit_px, taken);
    boxes.insert(boxes.end(), drawn.begin(), drawn.end());
  }
  return boxes;
}

}  // namespace terrella
