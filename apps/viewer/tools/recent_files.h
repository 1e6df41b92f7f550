#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Files, folders and addresses that the window opened, the newest first. thread: one
class RecentFiles {
 public:
  static constexpr std::size_t kMost = 8;

  /// A missing file gives an empty list. The error names a damaged file.
  [[nodiscard]] static Result<RecentFiles> load(const std::filesystem::path& file);
  /// Creates the folder if needed. The error names the file.
  [[nodiscard]] Status save(const std::filesystem::path& file) const;

  /// Puts a file first. Addresses with secrets are left out, because the list is stored as text.
  void add(const std::string& opened);
  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

 private:
  std::vector<std::string> all_;
};

/// Puts the opened files into the list of recent files, the first one first. Paths become absolute. thread: one
[[nodiscard]] Status remember_opened(std::span<const std::string> opened);

/// recent.json in $XDG_STATE_HOME/terrella or ~/.local/state/terrella; nullopt without such a folder.
[[nodiscard]] std::optional<std::filesystem::path> recent_file();

}  // namespace terrella
