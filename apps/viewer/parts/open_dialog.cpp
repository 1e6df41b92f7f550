#include "apps/viewer/parts/open_dialog.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "apps/open_scene/dated_files.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/tools/recent_files.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
constexpr float kOpenWidth = 34.0F;  // in text heights
constexpr float kLeastRows = 3.0F, kMostRows = 12.0F;

bool is_address(const std::string& text) { return text.find("://") != text.npos; }

/// True for an address, and for the pattern of dated files: neither is the name of a file.
bool names_no_file(const std::string& text) { return is_address(text) || names_dated_files(Url(text)); }

bool begins_with(const std::string& name, const std::string& start) {
  return name.size() >= start.size() && std::equal(start.begin(), start.end(), name.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
         });
}

/// A row of a list, within an ID of its own. A double click or Enter chooses it at once; a click only marks it.
enum class Row { left_alone, marked, chosen };
Row draw_row(const std::string& name, bool marked) {
  const std::string lines = wrapped(name, ImGui::GetContentRegionAvail().x) + "###row";
  const bool clicked = ImGui::Selectable(lines.c_str(), marked, ImGuiSelectableFlags_AllowDoubleClick);
  if (entered() || (clicked && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))) return Row::chosen;
  return clicked ? Row::marked : Row::left_alone;
}

}  // namespace

OpenDialog::OpenDialog(const ViewerContext& context, std::function<void(fs::path)> open)
    : Panel(context, "Open"), open_(std::move(open)) {
  std::error_code unknown;
  folder_ = fs::current_path(unknown);
}

void OpenDialog::take_keyboard() {
  Panel::take_keyboard();
  context_.ui.expect_text(true);
}

// Another window may have changed the files and the list of recent ones.
void OpenDialog::toggled() {
  text_.clear();
  if (!is_open()) return context_.ui.expect_text(false);
  enter(folder_);
  text_.clear();
  recent_.clear();
  const auto file = recent_file();
  if (!file) return;
  const auto recent = RecentFiles::load(*file);
  if (recent) recent_ = recent->all();
  if (!recent) problem_ = recent.error().message;
}

void OpenDialog::list() {
  auto entries = list_folder(folder_, all_);
  if (!entries) problem_ = entries.error().message;
  entries_ = entries ? *std::move(entries) : std::vector<FolderEntry>();
}

void OpenDialog::enter(const fs::path& folder) {
  folder_ = folder;
  text_ = (folder / "").string();
  begins_.clear();
  problem_.clear();
  list();
}

void OpenDialog::choose(const fs::path& file) {
  toggle();
  open_(file);
}

/// The path that the text means: below the listed folder unless it is absolute; "~/" is the home folder.
fs::path OpenDialog::path_of(const std::string& text) const {
  const char* home = std::getenv("HOME");
  if (text.starts_with("~/") && home != nullptr) return fs::path(home) / text.substr(2);
  return (folder_ / text).lexically_normal();
}

/// The folder of the line, or else the listed one.
fs::path OpenDialog::marked_folder() const {
  std::error_code unknown;
  const fs::path path = path_of(text_);
  return fs::is_directory(path, unknown) ? path : folder_;
}

// While a path is typed, the list follows it.
void OpenDialog::typed() {
  problem_.clear();
  begins_.clear();
  if (text_.empty() || is_address(text_)) return;
  const fs::path path = path_of(text_);
  const bool in_folder = text_.find('/') == text_.npos;
  begins_ = path.filename().string();
  std::error_code unknown;
  const fs::path folder = path.parent_path();
  if (in_folder || folder == folder_ || !fs::is_directory(folder, unknown)) return;
  folder_ = folder;
  list();
}

/// Opens the file or the address of the line, or enters its folder. A start of a name stands for the first entry that
/// has it.
void OpenDialog::take(const std::string& text) {
  if (text.empty()) return;
  if (names_no_file(text)) return choose(text);
  const fs::path path = path_of(text);
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) {
    enter(path);
    return take_keyboard();
  }
  if (fs::exists(path, unknown)) return choose(path);
  const auto found = std::ranges::find_if(
      entries_, [this](const FolderEntry& one) { return !begins_.empty() && begins_with(one.name, begins_); });
  if (found == entries_.end()) {
    begins_.clear();
    problem_ = fmt::format("{}: no such file or folder; choose one from the list, or correct the path", path.string());
    return;
  }
  found->is_folder ? enter(folder_ / found->name) : choose(folder_ / found->name);
}

void OpenDialog::draw_open(float foot) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float half = std::min(0.5F * kOpenWidth * unit, 0.5F * size.x - 0.8F * unit);
  const UiBox room = Ui::panel_room(0.5F * size.x - half, 0.5F * size.x + half, foot);
  const auto most = static_cast<float>(room.bottom - room.top);
  place_panel(room);
  ImGui::SetNextWindowBgAlpha(0.9F);
  const bool just_opened = take_just_opened();
  if (just_opened) ImGui::SetNextWindowFocus();
  begin_panel(panel());
  if (just_opened) ImGui::SetKeyboardFocusHere();
  draw_path();
  if (!problem_.empty()) write_wrapped(problem_);
  if (is_open()) draw_recent();
  const float row = ImGui::GetTextLineHeightWithSpacing();
  const float others = ImGui::GetCursorPosY() + 2.5F * ImGui::GetFrameHeightWithSpacing();
  if (is_open()) draw_entries(std::clamp(most - others, kLeastRows * row, kMostRows * row));
  if (is_open()) draw_buttons();
  ImGui::End();
}

void OpenDialog::draw_path() {
  std::array<char, 2048> text{};
  text_.copy(text.data(), text.size() - 1);
  ImGui::SetNextItemWidth(-1.0F);
  const bool entered = ImGui::InputTextWithHint("##path", "File, folder or address, then Enter", text.data(),
                                                text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  const bool edited = text_ != text.data();
  text_ = text.data();
  want_letters(text_);
  if (ImGui::IsItemActive()) context_.ui.field_is_ready();
  if (edited) typed();
  if (entered) take(text_);
}

void OpenDialog::draw_recent() {
  if (recent_.empty() || !begins_.empty()) return;
  group("Recent");
  for (std::size_t k = 0; k < recent_.size() && is_open(); ++k) {
    const std::string& path = recent_[k];
    const std::string name = is_address(path) ? path : fs::path(path).filename().string();
    ImGui::PushID(int(k));
    const Row row = draw_row(name, text_ == path);
    ImGui::PopID();
    tip(path);
    if (row == Row::marked) text_ = path;
    std::error_code unknown;
    if (row != Row::chosen) continue;
    if (names_no_file(path) || fs::exists(path, unknown)) return choose(path);
    problem_ = path + ": this file is not there any more; choose another one";
  }
}

void OpenDialog::draw_entries(float height) {
  group(panel_text(end_of(folder_.string(), ImGui::GetContentRegionAvail().x)).c_str());
  ImGui::BeginChild("##entries", {0.0F, height}, false, ImGuiWindowFlags_NavFlattened);
  if (begins_.empty() && folder_.has_relative_path() && draw_row("../", false) == Row::chosen) {
    enter(folder_.parent_path());
    take_keyboard();  // the next typed letters are a name again
  }
  std::size_t shown = 0;
  const std::vector<FolderEntry> entries = entries_;  // a choice replaces the list
  for (const FolderEntry& entry : entries) {
    if (!begins_with(entry.name, begins_)) continue;
    ++shown;
    const fs::path path = folder_ / entry.name;
    ImGui::PushID(entry.name.c_str());
    const Row row = draw_row(entry.name + (entry.is_folder ? "/" : ""), text_ == path.string());
    ImGui::PopID();
    if (row == Row::marked) text_ = path.string();
    if (row != Row::chosen) continue;
    if (!entry.is_folder) return ImGui::EndChild(), choose(path);
    enter(path);
    take_keyboard();
    break;
  }
  if (shown == 0) ImGui::TextDisabled("No file here that can be shown");
  ImGui::EndChild();
}

void OpenDialog::draw_buttons() {
  if (ImGui::Button("Open")) take(text_);
  tip("Opens the file or the address above, or shows what is in the folder above.");
  beside_if_room("Open folder");
  if (is_open() && ImGui::Button("Open folder")) choose(marked_folder());
  tip("Opens a folder as one layer: a folder of rasters, or of tiles.");
  beside_if_room("Close");
  if (is_open() && ImGui::Button("Close")) toggle();
  beside_if_room("All files    ");  // with its box
  if (ImGui::Checkbox("All files", &all_)) list();
  tip("Lists files of other kinds too.");
}

}  // namespace terrella
