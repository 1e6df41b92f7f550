#include "apps/viewer/bodies/body_question.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/viewer/bodies/body_names.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kQuestionWidth = 26.0F;  // in text heights

std::string name_of(const OtherBodyFile& file) { return shown_name(file.said); }

std::string question(const std::vector<OtherBodyFile>& files, const Body& globe) {
  const std::string what =
      files.size() == 1 ? name_of(files.front()) + " is" : fmt::format("{} files are", files.size());
  const bool by_name = std::ranges::all_of(files, &OtherBodyFile::by_name);
  return fmt::format("{} of {}{}, and this globe is {}.", what, body_phrase(files.front().body),
                     by_name ? " by name" : "", body_phrase(globe));
}

/// A button that the Enter key presses too.
bool button(const std::string& text) { return ImGui::Button(text.c_str()) || entered(); }

}  // namespace

void BodyQuestion::ask(OtherBodyFile file) {
  const auto same =
      std::ranges::find_if(waiting_, [&file](const auto& files) { return files.front().body.name == file.body.name; });
  same == waiting_.end() ? waiting_.push_back({std::move(file)}) : same->push_back(std::move(file));
  if (!is_open()) toggle();
}

// The panel closes with each answer, also without one: then the files are left out. The next question follows.
void BodyQuestion::toggled() {
  if (is_open() || waiting_.empty()) return;
  const std::vector<OtherBodyFile> files = std::exchange(waiting_.front(), {});
  waiting_.erase(waiting_.begin());
  if (!files.empty()) say(files.size() == 1 ? name_of(files.front()) + " was not opened" : "The files were not opened");
  if (!waiting_.empty()) toggle();
}

void BodyQuestion::answer_here() {
  for (OtherBodyFile& file : std::exchange(waiting_.front(), {})) {
    file.said.other_body = true;
    calls_.add_here(std::move(file.said));
  }
  toggle();
}

// Files of other bodies go along, and are asked about there.
void BodyQuestion::answer_globe() {
  std::vector<SourceOptions> sources;
  for (const auto& files : waiting_) {
    for (const OtherBodyFile& file : files) sources.push_back(file.said);
  }
  if (!calls_.open_globe(waiting_.front().front().body, std::move(sources))) return;
  waiting_.clear();
  toggle();
}

void BodyQuestion::draw_open(float foot) {
  const float unit = ImGui::GetFontSize(), middle = 0.5F * ImGui::GetIO().DisplaySize.x;
  const float half = std::min(0.5F * kQuestionWidth * unit, middle - 0.8F * unit);
  place_panel(Ui::panel_room(middle - half, middle + half, foot));
  ImGui::SetNextWindowBgAlpha(0.95F);
  const bool just_opened = take_just_opened();
  if (just_opened) ImGui::SetNextWindowFocus();
  begin_panel(panel());
  const std::vector<OtherBodyFile>& files = waiting_.front();
  write_wrapped(question(files, context_.globe.options().body));
  const std::string globe = "Globe of " + body_phrase(files.front().body);
  const bool to_globe = button(globe);
  if (just_opened) {
    ImGui::SetItemDefaultFocus();
    Ui::show_focus();
  }
  const bool may_lie_here = std::ranges::none_of(files, &OtherBodyFile::of_heights);
  bool here = false;
  if (may_lie_here) {
    beside_if_room("Layer here");
    here = button("Layer here");
    tip("Lays the picture over this globe by its longitudes and latitudes.");
  }
  beside_if_room("Cancel");
  const bool cancelled = button("Cancel");
  write_wrapped("Each body keeps its layers and its view.", true);
  ImGui::End();
  if (to_globe) return answer_globe();
  if (here) return answer_here();
  if (cancelled) toggle();
}

}  // namespace terrella
