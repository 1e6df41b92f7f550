#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"

namespace terrella {

/// Folder beside the output for incomplete work.
/// The file `key` in the folder identifies the work (options, pictures, their sizes and times). Only a run with the
/// same key resumes it. The file `lock` is locked (flock) while the run lives. Two runs therefore never share a folder,
/// and an unlocked folder is a leftover. The destructor removes the folder unless keep() was called. A killed run
/// leaves the folder behind. thread: one at a time
class WorkFolder {
 public:
  /// Opens a hidden folder beside the output: a leftover of a killed run with this key, else a new folder. Removes
  /// leftovers of killed runs for the same output with other keys.
  [[nodiscard]] static Result<WorkFolder> beside(const std::filesystem::path& output, const std::string& key);
  /// Opens the folder of that name, and empties it if it has another key. Fails if another run holds it.
  [[nodiscard]] static Result<WorkFolder> named(const std::filesystem::path& folder, const std::string& key);

  WorkFolder(WorkFolder&& other) noexcept : path_(std::move(other.path_)), lock_(other.lock_), keep_(other.keep_) {
    other.lock_ = -1;
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  WorkFolder& operator=(WorkFolder&&) = delete;
  ~WorkFolder();

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Keeps the folder when this object is destroyed.
  void keep() { keep_ = true; }

 private:
  WorkFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}
  std::filesystem::path path_;
  int lock_;  ///< file descriptor
  bool keep_ = false;
};

/// The text of a work folder's `key` file; empty if there is none. thread: any
[[nodiscard]] std::string key_of_folder(const std::filesystem::path& folder);

}  // namespace terrella
