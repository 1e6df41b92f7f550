#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "apps/viewer/draw/drawing.h"
#include "base/result.h"

namespace terrella {

/// The file in which the marks of the user stay between runs. It never replaces marks that this run does not have: the
/// file of another window, and a file that cannot be read whole, are set aside under another name. thread: one
class KeptDrawing {
 public:
  /// No file: nothing is kept.
  explicit KeptDrawing(std::optional<std::filesystem::path> file) : file_(std::move(file)) {
    if (!file_) problem_ = "there is no folder for settings, because HOME is not set";
  }

  struct Loaded {
    Drawing drawing;
    std::string complaint;  ///< tells what was set aside, or why nothing can be kept; may be empty
  };
  /// Loads the marks. A missing file has none.
  [[nodiscard]] Loaded load();
  /// Writes the marks, and creates the folder if needed. Returns a message if a file was set aside, else an empty text.
  /// The error says why the marks are not kept.
  [[nodiscard]] Result<std::string> save(const Drawing& drawing);

 private:
  [[nodiscard]] Result<std::string> text_now() const;
  [[nodiscard]] Result<std::filesystem::path> set_aside() const;
  [[nodiscard]] Error not_kept() const;

  std::optional<std::filesystem::path> file_;
  std::string problem_;  ///< the reason why nothing is kept; empty if the file can be written
  std::string known_;    ///< the file's text as this run has read or written it
};

/// drawings.geojson in the user's folder, beside the settings; drawings-NAME.geojson for another body than the Earth.
/// nullopt without such a folder. thread: any, while nobody changes the environment
[[nodiscard]] std::optional<std::filesystem::path> drawings_file(const std::string& body);

}  // namespace terrella
