#include "apps/viewer/catalogue/catalogue_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "apps/viewer/bodies/body_names.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/tools/folded_text.h"

namespace terrella {
namespace {

constexpr float kCatalogueWidth = 32.0F;  // in text heights
constexpr float kLeastLines = 4.0F, kMostLines = 26.0F;

std::string group_name(const CatalogueEntry& entry) { return body_title(entry.body) + ": " + entry.theme; }

/// Deepest level, dates, whom to thank, and the terms.
std::string details(const CatalogueEntry& entry) {
  const RemoteOptions& remote = entry.said.remote;
  return fmt::format("Level {}{}. {}. {}", remote.max_level.value_or(0), entry.has_dates ? ", dates" : "",
                     remote.attribution.value_or(""), entry.licence);
}

}  // namespace

CataloguePanel::CataloguePanel(const ViewerContext& context, bool offline,
                               std::function<void(const CatalogueEntry&)> add)
    : Panel(context, "Add data"), offline_(offline), add_(std::move(add)) {}

void CataloguePanel::take_keyboard() {
  Panel::take_keyboard();
  context_.ui.expect_text(true);
}

// The user may have changed the file since.
void CataloguePanel::toggled() {
  filter_.clear();
  if (!is_open()) return context_.ui.expect_text(false);
  catalogue_ = load_catalogue();
  for (const std::string& complaint : catalogue_.complaints) context_.messages.report(complaint);
  const std::string& here = context_.globe.options().body.name;
  std::stable_partition(catalogue_.entries.begin(), catalogue_.entries.end(),
                        [&here](const CatalogueEntry& entry) { return entry.body.name == here; });
  find();
}

void CataloguePanel::find() {
  found_.clear();
  marked_ = 0;
  const std::string wanted = folded(filter_);
  for (std::size_t i = 0; i < catalogue_.entries.size(); ++i) {
    const CatalogueEntry& entry = catalogue_.entries[i];
    const std::string all = folded(group_name(entry) + " " + entry.title + " " + details(entry));
    if (all.find(wanted) != all.npos) found_.push_back(i);
  }
}

void CataloguePanel::draw_filter(bool just_opened) {
  const FilterTyped typed = filter_field("Part of a name, a body or a theme", filter_, just_opened);
  entered_ = typed.entered;
  if (typed.has_keyboard) context_.ui.field_is_ready();
  if (typed.edited) find();
  if (typed.step > 0 && marked_ + 1 < found_.size()) ++marked_;
  if (typed.step < 0 && marked_ > 0) --marked_;
  reveal_ = typed.step != 0 || typed.edited;
}

bool CataloguePanel::draw_entry(const CatalogueEntry& entry, bool marked) const {
  const float room = ImGui::GetContentRegionAvail().x;
  const std::string title = wrapped(entry.title, room), quiet = wrapped(details(entry), room);
  const float height = ImGui::CalcTextSize(title.c_str()).y + ImGui::CalcTextSize(quiet.c_str()).y;
  const ImVec2 at = ImGui::GetCursorPos();
  const bool clicked = ImGui::Selectable("##entry", marked, 0, {0.0F, height});
  if (marked && reveal_) ImGui::SetScrollHereY();
  const ImVec2 next = ImGui::GetCursorPos();
  ImGui::SetCursorPos(at);
  ImGui::BeginGroup();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, 0.0F});
  ImGui::TextUnformatted(title.c_str());
  ImGui::TextDisabled("%s", quiet.c_str());
  ImGui::PopStyleVar();
  ImGui::EndGroup();
  ImGui::SetCursorPos(next);
  return clicked;
}

void CataloguePanel::draw_entries(float height) {
  ImGui::BeginChild("##entries", {0.0F, height}, false, ImGuiWindowFlags_NoNav);
  std::string shown;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const CatalogueEntry& entry = catalogue_.entries[found_[k]];
    if (std::string name = group_name(entry); name != shown) group(panel_text(shown = std::move(name)).c_str());
    ImGui::PushID(int(found_[k]));
    if (draw_entry(entry, k == marked_) || (entered_ && k == marked_)) chosen_ = &entry;
    ImGui::PopID();
  }
  if (found_.empty()) ImGui::TextDisabled("Nothing has this text");
  ImGui::EndChild();
}

void CataloguePanel::draw_open(float foot) {
  const float unit = ImGui::GetFontSize(), middle = 0.5F * ImGui::GetIO().DisplaySize.x;
  const float half = std::min(0.5F * kCatalogueWidth * unit, middle - 0.8F * unit);
  const UiBox room = Ui::panel_room(middle - half, middle + half, foot);
  place_panel(room);
  ImGui::SetNextWindowBgAlpha(0.9F);
  const bool just_opened = take_just_opened();
  if (just_opened) ImGui::SetNextWindowFocus();
  begin_panel(panel());
  if (offline_) write_wrapped("Offline: only what a cache holds is shown. Start without --offline for the rest.");
  draw_filter(just_opened);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const auto most = static_cast<float>(room.bottom - room.top) - ImGui::GetCursorPosY() - line;
  draw_entries(std::clamp(most, kLeastLines * line, kMostLines * line));
  ImGui::End();
  if (const CatalogueEntry* chosen = std::exchange(chosen_, nullptr)) {
    const CatalogueEntry entry = *chosen;
    toggle();
    add_(entry);
  }
}

}  // namespace terrella
