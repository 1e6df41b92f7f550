#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "apps/open_scene/options/scene_options.h"
#include "apps/viewer/parts/part.h"
#include "apps/viewer/projects/next_scene.h"

namespace terrella {

/// Saves the window's scene as a project, opens projects, and keeps the scene for the next start. Owns the panel.
/// thread: main for every call
class Projects : public Panel {
 public:
  /// `describe` returns the scene as the window shows it, without its drawings, which are kept by themselves;
  /// `drawings` returns these. `project` is the file that is open; may be empty. `restore`:
  /// the scene is kept for the next start.
  Projects(const ViewerContext& context, std::function<SceneOptions()> describe, std::function<std::string()> drawings,
           std::string project, bool restore);

  /// Leaves this scene for that of a project. A project that cannot be read is reported, and the scene stays.
  void open(const std::filesystem::path& project);
  /// Leaves this scene for another one.
  void leave_for(NextScene next) { next_ = std::move(next); }
  /// The scene that replaces this one. Nullopt: none does.
  [[nodiscard]] const std::optional<NextScene>& next() const { return next_; }
  void stay() { next_.reset(); }  ///< no scene replaces this one
  [[nodiscard]] bool restores() const { return restore_; }
  /// Saves the scene for the next start, and as that of its body, if the user wants it and the scene has changed.
  void keep_session();
  /// Leaves the kept session as it is until the scene changes.
  void hold_session() { held_ = true; }

  [[nodiscard]] bool changed() const override { return next_.has_value(); }
  void take_keyboard() override;

 private:
  void draw_open(float foot) override;
  void toggled() override;
  void draw_fields();
  void save();

  std::function<SceneOptions()> describe_;
  std::function<std::string()> drawings_;
  std::string project_;
  std::array<char, 1024> text_{};  ///< text in the line for the file
  std::string replaces_;           ///< an existing file that the next click on Save replaces
  std::optional<NextScene> next_;
  bool held_ = false;
  std::string kept_;  ///< text of the session file, as far as this window wrote it
  bool restore_;
};

/// session.terrella in $XDG_STATE_HOME/terrella or ~/.local/state/terrella; nullopt without such a folder. thread: any
[[nodiscard]] std::optional<std::filesystem::path> session_file();
/// session-moon.terrella there: the scene that the Moon, as an example, last had. thread: any
[[nodiscard]] std::optional<std::filesystem::path> session_file(const Body& body);

}  // namespace terrella
