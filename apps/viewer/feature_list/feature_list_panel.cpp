#include "apps/viewer/feature_list/feature_list_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kListWidth = 20.0F;     // in text heights; the middle of a window of 640 pixels stays free
constexpr float kWideWindow = 64.0F;    // in text heights; the list then stands beside the panel of layers
constexpr float kRoomForField = 15.0F;  // in text heights, of the contents
constexpr float kLeastTable = 4.0F;     // in rows, with the head
constexpr const char* kNoField = "Name only";

float row_height() { return std::ceil(ImGui::GetTextLineHeight() + 2.0F * ImGui::GetStyle().CellPadding.y); }

void place_list(float foot) {
  const float unit = ImGui::GetFontSize(), margin = 0.8F * unit, window = ImGui::GetIO().DisplaySize.x;
  const float width = std::min(kListWidth * unit, window - 2.0F * margin);
  const float left = window >= kWideWindow * unit ? margin : window - margin - width;
  place_panel(Ui::panel_room(left, left + width, foot));
  ImGui::SetNextWindowBgAlpha(0.85F);
}

void draw_filter(const ListContents& contents, std::string& filter, ListWish& wish) {
  const FilterTyped typed = filter_field("Part of a name or a value", filter, contents.takes_keyboard);
  tip("Arrows choose a row, Enter flies there.");
  wish.entered = typed.entered;
  wish.typing = typed.has_keyboard;
  wish.filtered = typed.edited;
  wish.step = typed.step;
}

void draw_field_choice(const ListContents& contents, ListWish& wish) {
  const std::string shown = contents.field.empty() ? kNoField : panel_text(contents.field);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  if (!ImGui::BeginCombo("##field", shown.c_str())) return tip("Shows this field beside the name.");
  if (ImGui::Selectable(kNoField, contents.field.empty())) wish.field = std::string();
  for (const std::string& field : contents.table->fields) {
    ImGui::PushID(&field);
    if (ImGui::Selectable(panel_text(field).c_str(), field == contents.field)) wish.field = field;
    ImGui::PopID();
  }
  ImGui::EndCombo();
}

void draw_head(const ListContents& contents, std::string& filter, ListWish& wish) {
  draw_filter(contents, filter, wish);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(fmt::format("{} of {}", contents.found.size(), contents.table->names.size()).c_str());
  ImGui::SameLine();
  draw_field_choice(contents, wish);
}

/// Scrolls so that a row is in view. For use inside the table.
void reveal(std::size_t place, float height) {
  const float row = row_height(), top = static_cast<float>(place) * row, at = ImGui::GetScrollY();
  const float room = std::max(row, height - row);  // under the head
  if (top < at) ImGui::SetScrollY(top);
  if (top + row > at + room) ImGui::SetScrollY(top + row - room);
}

void draw_cell(const std::string& text) {
  const float room = ImGui::GetContentRegionAvail().x;
  const std::string shown = panel_text(text);
  ImGui::TextUnformatted(shown.c_str());
  if (ImGui::CalcTextSize(shown.c_str()).x > room && ImGui::IsItemHovered()) tip(text);
}

void draw_row(const ListContents& contents, bool with_field, std::uint32_t row, ListWish& wish) {
  ImGui::TableNextRow(ImGuiTableRowFlags_None, row_height());
  ImGui::TableNextColumn();
  ImGui::PushID(static_cast<int>(row));
  constexpr int kFlags = int(ImGuiSelectableFlags_SpanAllColumns) | int(ImGuiSelectableFlags_AllowItemOverlap);
  if (ImGui::Selectable("##row", contents.selected == row, kFlags)) wish.clicked = row;
  ImGui::SameLine(0.0F, 0.0F);
  draw_cell(contents.table->names[row]);
  if (with_field && ImGui::TableNextColumn() && contents.column != nullptr) draw_cell(contents.column->values[row]);
  ImGui::PopID();
}

void take_sort(ListWish& wish) {
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (specs == nullptr || specs->SpecsCount == 0) return;
  wish.sort = {.by_field = specs->Specs->ColumnIndex == 1,
               .descending = specs->Specs->SortDirection == ImGuiSortDirection_Descending};
}

// The keyboard reaches rows by the arrows in the filter, not one after the other.
void draw_rows(const ListContents& contents, bool with_field, float height, ListWish& wish) {
  if (contents.reveal && contents.selected) {
    const auto at = std::ranges::find(contents.found, *contents.selected);
    if (at != contents.found.end()) reveal(std::size_t(at - contents.found.begin()), height);
  }
  ImGui::PushItemFlag(ImGuiItemFlags_NoNav, true);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(contents.found.size()), row_height());
  while (clipper.Step()) {
    for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) {
      draw_row(contents, with_field, contents.found[std::size_t(k)], wish);
    }
  }
  ImGui::PopItemFlag();
}

void draw_table(const ListContents& contents, float bottom, ListWish& wish) {
  const bool with_field =
      !contents.field.empty() && ImGui::GetContentRegionAvail().x >= kRoomForField * ImGui::GetFontSize();
  const float row = row_height();
  const float room = bottom - ImGui::GetCursorScreenPos().y - ImGui::GetStyle().WindowPadding.y;
  const float wanted = row * static_cast<float>(contents.table->names.size() + 1);
  const float height = row * std::max(kLeastTable, std::floor(std::min(room, wanted) / row));
  constexpr int kFlags = int(ImGuiTableFlags_ScrollY) | int(ImGuiTableFlags_Sortable) | int(ImGuiTableFlags_RowBg) |
                         int(ImGuiTableFlags_Resizable) | int(ImGuiTableFlags_SizingStretchProp) |
                         int(ImGuiTableFlags_NoSavedSettings);
  // Another table for each choice, so that it begins with the widths and the order of its own.
  ImGui::PushID(contents.field.c_str());
  if (ImGui::BeginTable("##features", with_field ? 2 : 1, kFlags, {0.0F, height})) {
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("Name", ImGuiTableColumnFlags_DefaultSort, 0.6F);
    if (with_field) ImGui::TableSetupColumn(panel_text(contents.field).c_str(), ImGuiTableColumnFlags_None, 0.4F);
    ImGui::TableHeadersRow();
    take_sort(wish);
    draw_rows(contents, with_field, height, wish);
    ImGui::EndTable();
  }
  ImGui::PopID();
}

}  // namespace

ListWish draw_feature_list(const char* title, const ListContents& contents, std::string& filter, float foot) {
  place_list(foot);
  if (contents.takes_keyboard) ImGui::SetNextWindowFocus();
  begin_panel(title);
  const UiBox room = Ui::panel_room(ImGui::GetWindowPos().x, ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), foot);
  ListWish wish;
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  ImGui::TextUnformatted(panel_text(end_of(contents.layer, ImGui::GetContentRegionAvail().x)).c_str());
  ImGui::PopStyleColor();
  if (contents.table == nullptr) {
    write_wrapped("Reading the features", true);
  } else {
    draw_head(contents, filter, wish);
    draw_table(contents, static_cast<float>(room.bottom), wish);
  }
  ImGui::End();
  return wish;
}

}  // namespace terrella
