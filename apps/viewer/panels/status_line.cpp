#include "apps/viewer/panels/status_line.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kMargin = 0.8F;          // in text heights, between panels and the window's edge
constexpr float kUnderMessage = 0.4F;    // in text heights, between the message and the status line
constexpr float kMessageHeight = 4.0F;   // in text heights, of most messages
constexpr float kLeastMessage = 14.0F;   // in text heights, of a message beside panels
constexpr float kColumnWidth = 3.0F;     // in text heights, of the buttons at the right edge, at most
constexpr float kWidestMessage = 0.85F;  // share of the window's width
constexpr float kLeastHeight = 14.0F;    // in text heights, of a window with a scale bar
constexpr float kNarrow = 50.0F;         // in text heights; the attribution takes the whole width of a narrower window
constexpr float kTick = 0.35F;           // in text heights, of the scale bar
constexpr float kFaultBar = 0.25F;       // in text heights, beside a fault
const ImU32 kInk = IM_COL32(232, 240, 248, 255), kFault = IM_COL32(255, 120, 90, 255);

float margin() { return kMargin * ImGui::GetFontSize(); }

struct Field {
  std::string text;
  bool quiet = false, fault = false;
};

void draw_text(const Field& field) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(field.quiet ? ImGuiCol_TextDisabled : ImGuiCol_Text));
  ImGui::TextUnformatted(field.text.c_str());
  ImGui::PopStyleColor();
}

float gap_of_fields() { return 1.3F * ImGui::GetFontSize(); }

/// Width of a panel with one line of text; 0 without text.
float row_width(const std::vector<Field>& fields) {
  float width = 2.0F * ImGui::GetStyle().WindowPadding.x - gap_of_fields();
  for (const Field& field : fields) width += gap_of_fields() + ImGui::CalcTextSize(field.text.c_str()).x;
  return fields.empty() ? 0.0F : width;
}

/// Returns the fields with text that fit alone, without the last ones if the panel would be wider than `most`.
std::vector<Field> fitted(std::vector<Field> fields, float most) {
  std::erase_if(fields, [most](const Field& field) { return field.text.empty() || row_width({field}) > most; });
  while (row_width(fields) > most) fields.pop_back();
  return fields;
}

/// Draws a panel with one line of text; without text draws nothing.
void draw_row(const char* name, const std::vector<Field>& fields, ImVec2 at, ImVec2 pivot) {
  if (fields.empty()) return;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  begin_fixed(name, at, pivot, {row_width(fields) - 2.0F * padding, ImGui::GetFontSize()});
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) ImGui::SameLine(0.0F, gap_of_fields());
    draw_text(fields[i]);
  }
  ImGui::End();
}

/// Draws a panel with wrapped text; empty text draws nothing.
void draw_wrapped(const char* name, const Field& field, ImVec2 at, ImVec2 pivot, float widest) {
  if (field.text.empty()) return;
  const Field lines{wrapped(field.text, widest), field.quiet};
  begin_fixed(name, at, pivot, ImGui::CalcTextSize(lines.text.c_str()));
  if (field.fault) {
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const ImVec2 end{corner.x + kFaultBar * ImGui::GetFontSize(), corner.y + size.y};
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRectFullScreen();  // the bar lies in the window's padding
    list->AddRectFilled(corner, end, kFault, ImGui::GetStyle().WindowRounding, ImDrawFlags_RoundCornersLeft);
    list->PopClipRect();
  }
  draw_text(lines);
  ImGui::End();
}

/// Draws wrapped text with its upper edge and a share of its width at a position, unless it would cover other texts.
void draw_at_head(const char* name, const Field& field, ImVec2 at, float share, float widest) {
  const ImVec2 size = ImGui::CalcTextSize(wrapped(field.text, widest).c_str());
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const double width = double(size.x + 2.0F * padding.x), left = double(at.x) - double(share) * width;
  const UiBox box{left, double(at.y), left + width, double(at.y + size.y + 2.0F * padding.y)};
  const auto covers = [&box](const UiBox& other) { return other.overlaps(box); };
  if (box.bottom > double(ImGui::GetIO().DisplaySize.y)) return;
  if (std::ranges::none_of(Ui::panel_boxes(), covers)) draw_wrapped(name, field, at, {share, 0.0F}, widest);
}

/// The room for a message: from left to right, and up from the bottom.
struct MessageRoom {
  float left, right, bottom;
};

/// The room beside the panels that reach down to the message, or the whole width above the texts at the lower edge.
MessageRoom room_for_message(float foot) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float unit = ImGui::GetFontSize(), bottom = size.y - foot - kUnderMessage * unit;
  MessageRoom beside{margin(), size.x - margin(), bottom}, above = beside;
  const auto avoid = [&](const UiBox& box, bool text) {
    const auto left = static_cast<float>(box.left), right = static_cast<float>(box.right);
    const auto top = static_cast<float>(box.top);
    if (static_cast<float>(box.bottom) < bottom - kMessageHeight * unit || top > bottom) return;
    0.5F * (left + right) < 0.5F * size.x ? beside.left = std::max(beside.left, right + 0.5F * margin())
                                          : beside.right = std::min(beside.right, left - 0.5F * margin());
    if (!text && right - left < kColumnWidth * unit && left > 0.5F * size.x) {
      above.right = std::min(above.right, left - 0.5F * margin());  // the buttons stay where they are
    }
    if (text && top > 0.3F * size.y) above.bottom = std::min(above.bottom, top - 0.5F * margin());
  };
  for (const UiBox& box : Ui::panel_boxes()) avoid(box, true);
  for (const UiBox& box : Ui::last_panels()) avoid(box, false);
  return beside.right - beside.left < kLeastMessage * unit ? above : beside;
}

/// Size of the scale bar with its text, without the panel's padding.
ImVec2 scale_size(const ScaleBar& bar, double unit_px) {
  const float unit = ImGui::GetFontSize();
  const float text = ImGui::CalcTextSize(bar.text.c_str()).x;
  return {std::max(static_cast<float>(bar.width_px / unit_px), text), unit + kTick * unit + 2.0F};
}

void draw_bar(const ScaleBar& bar, ImVec2 lower_right, double unit_px) {
  const ImVec2 size = scale_size(bar, unit_px);
  const float width = static_cast<float>(bar.width_px / unit_px);
  const float tick = kTick * ImGui::GetFontSize();
  begin_fixed("##scale", lower_right, {1.0F, 1.0F}, size);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddText({at.x + 0.5F * (size.x - ImGui::CalcTextSize(bar.text.c_str()).x), at.y}, kInk, bar.text.c_str());
  const float left = at.x + 0.5F * (size.x - width);
  const float base = at.y + size.y;
  const ImVec2 points[] = {{left, base - tick}, {left, base}, {left + width, base}, {left + width, base - tick}};
  list->AddPolyline(points, 4, kInk, 0, line_width(1.5F));
  ImGui::End();
}

/// Draws the status line at the left and the scale bar at the right, or above it if both do not fit. Returns the height
/// that they use.
float draw_foot(const PanelStatus& status, double unit_px) {
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const float gap = margin(), room = size.x - 2.0F * gap;
  const auto fields =
      fitted({{panel_text(status.cursor)}, {status.eye}, {status.tiles, true}, {status.time, true}}, room);
  draw_row("##status", fields, {gap, size.y - gap}, {0.0F, 1.0F});
  const float row = ImGui::GetFontSize() + 2.0F * padding.y;
  if (!status.scale || size.y < kLeastHeight * ImGui::GetFontSize()) return gap + row;
  const ImVec2 scale = scale_size(*status.scale, unit_px);
  const bool above = row_width(fields) + gap + scale.x + 2.0F * padding.x > room;
  const float foot = above ? 1.5F * gap + row : gap;
  draw_bar(*status.scale, {size.x - gap, size.y - foot}, unit_px);
  return foot + scale.y + 2.0F * padding.y;
}

}  // namespace

float draw_status(const PanelStatus& status, double unit_px) { return draw_foot(status, unit_px); }

void draw_scale(const ScaleBar& bar) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  draw_bar(bar, {size.x - margin(), size.y - margin()}, 1.0);
}

void draw_head(const PanelStatus& status) {
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const float gap = margin(), whole = size.x - 2.0F * gap - 2.0F * padding.x;
  const bool narrow = size.x < kNarrow * ImGui::GetFontSize();
  const bool hidden = status.attribution.empty();
  const std::string& text = hidden ? status.last_attribution : status.attribution;
  if (hidden) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.0F);
  draw_at_head(kAttributionBox, {text, true}, {size.x - gap, gap}, 1.0F, narrow ? whole : 0.5F * whole);
  if (hidden) ImGui::PopStyleVar();
}

void draw_message(const PanelStatus& status, float foot) {
  std::string text = status.job;
  if (!text.empty() && !status.message.empty()) text += "\n";
  text += status.message;
  if (status.is_fault) text += "\nEsc closes this";
  const MessageRoom room = room_for_message(foot);
  const float whole = std::min(room.right - room.left, kWidestMessage * ImGui::GetIO().DisplaySize.x);
  draw_wrapped("##message", {text, false, status.is_fault}, {0.5F * (room.left + room.right), room.bottom},
               {0.5F, 1.0F}, whole - 2.0F * ImGui::GetStyle().WindowPadding.x);
}

}  // namespace terrella
