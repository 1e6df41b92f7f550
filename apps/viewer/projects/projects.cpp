#include "apps/viewer/projects/projects.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "apps/open_scene/project/read_project.h"
#include "apps/open_scene/project/write_project.h"
#include "apps/process/console.h"
#include "apps/process/user_folder.h"
#include "apps/viewer/bodies/body_names.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/tools/kept_json.h"
#include "apps/viewer/tools/recent_files.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
constexpr float kProjectWidth = 26.0F;  // in text heights
constexpr const char* kEnding = ".terrella";

}  // namespace

Projects::Projects(const ViewerContext& context, std::function<SceneOptions()> describe,
                   std::function<std::string()> drawings, std::string project, bool restore)
    : Panel(context, "Project"),
      describe_(std::move(describe)),
      drawings_(std::move(drawings)),
      project_(std::move(project)),
      restore_(restore) {}

void Projects::open(const fs::path& project) {
  SceneOptions scene;
  const Status read = read_project(project, scene);
  if (!read) return context_.messages.report(read.error().message);
  leave_for({.project = project});
}

void Projects::take_keyboard() {
  Panel::take_keyboard();
  context_.ui.expect_text(true);
}

void Projects::toggled() {
  replaces_.clear();
  if (!is_open()) return context_.ui.expect_text(false);
  const std::string shown = project_.empty() ? std::string("globe") + kEnding : project_;
  text_.fill('\0');
  shown.copy(text_.data(), text_.size() - 1);
}

void Projects::draw_open(float foot) {
  const bool just_opened = take_just_opened();
  begin_left_panel(panel(), kProjectWidth, foot, just_opened);
  if (just_opened) ImGui::SetKeyboardFocusHere();
  draw_fields();
  ImGui::End();
}

void Projects::draw_fields() {
  ImGui::SetNextItemWidth(-1.0F);
  bool save_now = ImGui::InputTextWithHint("##file", "File, then Enter", text_.data(), text_.size(),
                                           ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemActive()) context_.ui.field_is_ready();
  tip("Name of the project's file. Without a folder it goes to the folder where the program was started.");
  want_letters(text_.data());
  save_now = ImGui::Button(replaces_.empty() ? "Save###save" : "Replace###save") || entered() || save_now;
  tip("Saves layers, looks, view and time. terrella view and terrella render open the file.");
  beside_if_room("New");
  if (ImGui::Button("New") || entered()) leave_for({.body = context_.globe.options().body, .afresh = true});
  tip("Leaves this scene for the globe of its body as at the first start.");
  ImGui::Checkbox("Restore at the next start", &restore_);
  tip("Without a file, the program then starts with the scene that was last open.");
  write_wrapped("Ctrl + O opens a project. Addresses with a password or a key are not saved.", true);
  if (save_now) save();
}

void Projects::save() {
  std::string name = text_.data();
  if (name.empty()) return say("Type a name for the project's file");
  if (!name.ends_with(kEnding)) name += kEnding;
  std::error_code unknown;
  const fs::path file = fs::absolute(name, unknown).lexically_normal();
  if (file.string() != project_ && fs::exists(file, unknown) && replaces_ != file.string()) {
    replaces_ = file.string();
    return say(fmt::format("{} exists; save again to replace it", file.filename().string()));
  }
  SceneOptions scene = describe_();
  scene.drawings = drawings_();
  const ProjectText project = project_text(scene, file.parent_path());
  if (const Status saved = write_kept_text(file, project.text); !saved) {
    return context_.messages.report(saved.error().message);
  }
  project_ = file.string();
  toggle();
  say("Saved " + file.string());
  for (const std::string& left_out : project.left_out) context_.messages.report(left_out);
  const Status kept = remember_opened(std::array{project_});
  if (!kept) say(kept.error());
}

// A failure is reported once, because the scene then counts as kept.
void Projects::keep_session() {
  const auto file = session_file();
  if (!restore_ || !file) return;
  std::string text = project_text(describe_(), {}).text;
  if (text == kept_) return;
  kept_ = std::move(text);
  if (std::exchange(held_, false)) return;
  Status saved = write_kept_text(*file, kept_);
  if (saved) saved = write_kept_text(*session_file(context_.globe.options().body), kept_);
  if (!saved) say(saved.error());
}

std::optional<fs::path> session_file() {
  const auto folder = user_folder("XDG_STATE_HOME", ".local/state");
  return folder ? std::optional(*folder / "session.terrella") : std::nullopt;
}

std::optional<fs::path> session_file(const Body& body) {
  const auto file = session_file();
  if (!file) return std::nullopt;
  return file->parent_path() / fmt::format("session-{}.terrella", body_file_word(body.name));
}

}  // namespace terrella
