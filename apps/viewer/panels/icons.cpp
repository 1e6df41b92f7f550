#include "apps/viewer/panels/icons.h"

#include <cmath>
#include <vector>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

using Stroke = std::vector<ImVec2>;  // half the side of the button is 1, y down

const ImU32 kIconInk = IM_COL32(232, 240, 248, 255);
const ImU32 kNorth = IM_COL32(232, 84, 72, 255);

std::vector<Stroke> strokes_of(Icon icon) {
  switch (icon) {
    case Icon::menu:
      return {{{-0.45F, -0.35F}, {0.45F, -0.35F}}, {{-0.45F, 0.0F}, {0.45F, 0.0F}}, {{-0.45F, 0.35F}, {0.45F, 0.35F}}};
    case Icon::plus:
      return {{{-0.45F, 0.0F}, {0.45F, 0.0F}}, {{0.0F, -0.45F}, {0.0F, 0.45F}}};
    case Icon::minus:
      return {{{-0.45F, 0.0F}, {0.45F, 0.0F}}};
    case Icon::tilted:  // the ground in perspective
      return {{{-0.55F, 0.35F}, {-0.25F, -0.3F}, {0.25F, -0.3F}, {0.55F, 0.35F}, {-0.55F, 0.35F}}};
    case Icon::flat:  // the ground from above
      return {{{-0.4F, -0.4F}, {0.4F, -0.4F}, {0.4F, 0.4F}, {-0.4F, 0.4F}, {-0.4F, -0.4F}}};
    case Icon::home:
      return {{{-0.55F, 0.0F}, {0.0F, -0.5F}, {0.55F, 0.0F}},
              {{-0.38F, -0.05F}, {-0.38F, 0.45F}, {0.38F, 0.45F}, {0.38F, -0.05F}}};
    case Icon::back:
      return {{{0.5F, 0.0F}, {-0.5F, 0.0F}}, {{-0.1F, -0.4F}, {-0.5F, 0.0F}, {-0.1F, 0.4F}}};
    case Icon::forward:
      return {{{-0.5F, 0.0F}, {0.5F, 0.0F}}, {{0.1F, -0.4F}, {0.5F, 0.0F}, {0.1F, 0.4F}}};
    case Icon::none:
    case Icon::compass:
      return {};
  }
  return {};
}

// A needle; its red half points to north.
void draw_compass(ImDrawList* list, ImVec2 centre, float half, Angle heading) {
  const auto sine = static_cast<float>(std::sin(heading.rad())), cosine = static_cast<float>(std::cos(heading.rad()));
  const auto turned = [&](float right, float up) {
    return ImVec2{centre.x + half * (right * cosine - up * sine), centre.y - half * (right * sine + up * cosine)};
  };
  list->AddCircle(centre, 0.82F * half, kIconInk, 0, line_width(1.2F));
  list->AddTriangleFilled(turned(-0.24F, 0.0F), turned(0.0F, 0.66F), turned(0.24F, 0.0F), kNorth);
  list->AddTriangleFilled(turned(-0.24F, 0.0F), turned(0.24F, 0.0F), turned(0.0F, -0.66F), kIconInk);
}

}  // namespace

void draw_icon(Icon icon, ImVec2 centre, float half, Angle heading) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (icon == Icon::compass) return draw_compass(list, centre, half, heading);
  for (const Stroke& stroke : strokes_of(icon)) {
    std::vector<ImVec2> points;
    for (const ImVec2& point : stroke) points.push_back({centre.x + half * point.x, centre.y + half * point.y});
    list->AddPolyline(points.data(), static_cast<int>(points.size()), kIconInk, 0, line_width(1.6F));
  }
}

}  // namespace terrella
