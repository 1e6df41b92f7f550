#include "apps/viewer/panels/control_column.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "apps/viewer/action.h"
#include "apps/viewer/panels/free_place.h"
#include "apps/viewer/panels/panel_items.h"
#include "geo/angle.h"

namespace terrella {
namespace {

using Stroke = std::vector<ImVec2>;  // half the side of the button is 1, y down

const ImU32 kIconInk = IM_COL32(232, 240, 248, 255);
const ImU32 kNorth = IM_COL32(232, 84, 72, 255);

Stroke circle(ImVec2 centre, float radius) {
  constexpr int kSides = 20;
  Stroke stroke;
  for (int k = 0; k <= kSides; ++k) {
    const Angle angle = Angle::degrees(360.0 * k / kSides);
    stroke.push_back({centre.x + radius * static_cast<float>(std::sin(angle.rad())),
                      centre.y - radius * static_cast<float>(std::cos(angle.rad()))});
  }
  return stroke;
}

std::vector<Stroke> strokes_of(Icon icon) {
  switch (icon) {
    case Icon::search:
      return {circle({-0.12F, -0.12F}, 0.34F), {{0.14F, 0.14F}, {0.5F, 0.5F}}};
    case Icon::layers:  // two sheets
      return {{{0.0F, -0.5F}, {0.55F, -0.18F}, {0.0F, 0.14F}, {-0.55F, -0.18F}, {0.0F, -0.5F}},
              {{-0.55F, 0.12F}, {0.0F, 0.44F}, {0.55F, 0.12F}}};
    case Icon::clock:
      return {circle({0.0F, 0.0F}, 0.5F), {{0.0F, -0.3F}, {0.0F, 0.0F}, {0.22F, 0.14F}}};
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

/// Draws an icon around a centre into the current panel. `half`: half the side of its button, in units of the window.
/// The compass shows where north is for a view with this heading. thread: main
void draw_icon(Icon icon, ImVec2 centre, float half, Angle heading) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (icon == Icon::compass) return draw_compass(list, centre, half, heading);
  for (const Stroke& stroke : strokes_of(icon)) {
    std::vector<ImVec2> points;
    for (const ImVec2& point : stroke) points.push_back({centre.x + half * point.x, centre.y + half * point.y});
    list->AddPolyline(points.data(), static_cast<int>(points.size()), kIconInk, 0, line_width(1.6F));
  }
}

constexpr float kButton = 1.75F;        // in text heights
constexpr float kColumnPadding = 0.2F;  // in text heights, around the buttons
constexpr float kColumnMargin = 0.8F;   // in text heights, to the window's edge
constexpr float kBetween = 0.5F;        // in text heights, to other panels
constexpr std::size_t kEnough = 4;      // this many buttons at the right edge are better than more elsewhere
constexpr std::size_t kLeast = 3;       // fewer buttons are not worth a column
// The first have room first.
constexpr std::array kByWorth = {Icon::menu, Icon::compass, Icon::plus, Icon::minus, Icon::search,  Icon::layers,
                                 Icon::home, Icon::tilted,  Icon::flat, Icon::back,  Icon::forward, Icon::clock};

/// Actions with an icon, from top to bottom, without those for which there is no room.
std::vector<const Action*> buttons_of(std::span<const Action> actions, std::size_t room) {
  std::vector<const Action*> buttons;
  for (const Action& action : actions) {
    const auto worth = std::size_t(std::ranges::find(kByWorth, action.icon) - kByWorth.begin());
    if (action.icon != Icon::none && worth < room) buttons.push_back(&action);
  }
  std::ranges::sort(buttons, {}, [](const Action* action) { return action->icon; });
  return buttons;
}

struct ColumnPlace {
  double left = 0.0;
  UiSpan height;
};

/// The rightmost place with room for `enough`, or else the one with the most room.
ColumnPlace place_of(float width, float enough) {
  const float unit = ImGui::GetFontSize(), margin = kColumnMargin * unit;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  std::vector<UiBox> taken = Ui::panel_boxes();
  std::vector<double> lefts{double(size.x - margin - width)};
  for (UiBox& box : taken) {
    box = {box.left - kBetween * unit, box.top - kBetween * unit, box.right + kBetween * unit,
           box.bottom + kBetween * unit};
    lefts.push_back(box.left - width);
  }
  std::ranges::sort(lefts, std::greater<>());
  ColumnPlace best;
  for (const double left : lefts) {
    if (left < double(margin) || left > double(size.x - margin - width)) continue;
    const UiSpan height = free_height({left, left + width}, {margin, size.y - margin}, taken);
    if (height.length() > best.height.length()) best = {left, height};
    if (best.height.length() >= double(enough)) break;
  }
  return best;
}

bool draw_button(const Action& action, Angle heading, ImVec2 size) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushButtonRepeat((action.flags & Action::repeats) != 0);
  const bool clicked = ImGui::Button(fmt::format("##{}", int(action.icon)).c_str(), size);
  ImGui::PopButtonRepeat();
  draw_icon(action.icon, {at.x + 0.5F * size.x, at.y + 0.5F * size.y}, 0.5F * size.x, heading);
  tip(fmt::format("{}: {}", action.keys, action.what));
  return clicked;
}

}  // namespace

ControlColumn draw_control_column(std::span<const Action> actions, Angle heading) {
  const float unit = ImGui::GetFontSize(), padding = kColumnPadding * unit, button = std::floor(kButton * unit);
  const float width = button + 2.0F * padding;
  const ColumnPlace place = place_of(width, float(kEnough) * button + 2.0F * padding);
  const auto room = std::size_t(std::max(0.0, (place.height.length() - 2.0 * double(padding)) / double(button)));
  const std::vector<const Action*> buttons = buttons_of(actions, room);
  ControlColumn column;
  if (buttons.size() < kLeast) return column;
  const float height = float(buttons.size()) * button + 2.0F * padding;
  const double top = place.height.to - double(height);
  const auto menu = Ui::shown_box(kMenuTitle);
  if (menu && menu->overlaps({place.left, top, place.left + width, place.height.to})) return column;
  ImGui::SetNextWindowPos({float(place.left), float(top)});
  ImGui::SetNextWindowSize({width, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {padding, padding});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, 0.0F});
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0.0F);
  ImGui::PushStyleColor(ImGuiCol_Button, 0U);
  ImGui::Begin("##controls", nullptr, kFloatingWindow);
  for (const Action* action : buttons) {
    if (draw_button(*action, heading, {button, button})) column.clicked = action;
    column.held |= ImGui::IsItemActive();
  }
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
  return column;
}

}  // namespace terrella
