#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// Views that a person wants to come back to, nine of them, kept in a file between runs. thread: one
class Bookmarks {
 public:
  static constexpr int kMost = 9;

  /// Of a file that is not there: none. Fails if it cannot be read or is no file of bookmarks; a bookmark that is no
  /// camera is left out.
  [[nodiscard]] static Result<Bookmarks> load(const std::filesystem::path& file);
  /// Makes the folder if need be. What another run has kept since is lost. Fails with a message that names the file.
  [[nodiscard]] Status save(const std::filesystem::path& file) const;

  /// `number` in [1, kMost].
  [[nodiscard]] const std::optional<Camera>& at(int number) const { return cameras_.at(std::size_t(number) - 1); }
  void set(int number, const Camera& camera) { cameras_.at(std::size_t(number) - 1) = camera; }

 private:
  std::array<std::optional<Camera>, kMost> cameras_;
};

/// $XDG_CONFIG_HOME/terrella/bookmarks.json, or ~/.config/terrella/bookmarks.json; nothing where neither is known.
[[nodiscard]] std::optional<std::filesystem::path> bookmarks_file();

}  // namespace terrella
