#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// Nine stored views of the user, kept in a file between runs. thread: one
class Bookmarks {
 public:
  static constexpr int kMost = 9;

  /// Loads a file; a missing file gives no bookmarks. Fails if the file cannot be read or has another format. Invalid
  /// cameras are skipped.
  [[nodiscard]] static Result<Bookmarks> load(const std::filesystem::path& file);
  /// Saves the bookmarks and creates the folder if needed. Overwrites changes that another run has saved since. The
  /// error names the file.
  [[nodiscard]] Status save(const std::filesystem::path& file) const;

  /// `number` in [1, kMost].
  [[nodiscard]] const std::optional<Camera>& at(int number) const { return cameras_.at(std::size_t(number) - 1); }
  void set(int number, const Camera& camera) { cameras_.at(std::size_t(number) - 1) = camera; }

 private:
  std::array<std::optional<Camera>, kMost> cameras_;
};

/// Returns $XDG_CONFIG_HOME/terrella/bookmarks.json or ~/.config/terrella/bookmarks.json; nullopt if neither folder is
/// known.
[[nodiscard]] std::optional<std::filesystem::path> bookmarks_file();

}  // namespace terrella
