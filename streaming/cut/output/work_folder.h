#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"

namespace terrella {

/// Where a run keeps what is not whole yet, beside the output. The file `key` in it says for what (options, pictures,
/// their sizes and times): only a run with the same key goes on with it. The file `lock` is locked (flock) as long as
/// the run lives, so that two runs never share a folder and a folder that nobody holds is known to be left over.
/// Removed with its owner unless keep() was called; not removed by a killed one. thread: one at a time
class WorkFolder {
 public:
  /// A hidden folder beside the output: one with this key that a killed run has left, else a new one. Removes what
  /// killed runs for the same output have left under other keys.
  [[nodiscard]] static Result<WorkFolder> beside(const std::filesystem::path& output, const std::string& key);
  /// The folder of that name; emptied if it was made for something else. An error if another run holds it.
  [[nodiscard]] static Result<WorkFolder> named(const std::filesystem::path& folder, const std::string& key);

  WorkFolder(WorkFolder&& other) noexcept : path_(std::move(other.path_)), lock_(other.lock_), keep_(other.keep_) {
    other.lock_ = -1;
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  WorkFolder& operator=(WorkFolder&&) = delete;
  ~WorkFolder();

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// From now on it stays when its owner goes.
  void keep() { keep_ = true; }

 private:
  WorkFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}
  std::filesystem::path path_;
  int lock_;  ///< file descriptor
  bool keep_ = false;
};

/// The text of a work folder's `key`; empty if there is none. thread: any
[[nodiscard]] std::string key_of_folder(const std::filesystem::path& folder);

}  // namespace terrella
