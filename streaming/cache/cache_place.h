#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/result.h"

namespace terrella {

/// Notices that other programs removed, renamed, replaced or cut off the file of an open cache. SQLite writes on into a
/// file without a name and reports no error. Never opens the file itself: to close it would end SQLite's locks
/// (https://www.sqlite.org/howtocorrupt.html, 2.2). thread: one at a time
class CachePlace {
 public:
  /// Call when the file has just been opened.
  explicit CachePlace(std::filesystem::path path);
  /// Returns the same error again once there was one. The error names the file.
  [[nodiscard]] Status check();
  /// Call after the log was written back, which may shorten the file.
  void note_size();

 private:
  struct File {
    std::uint64_t device = 0, number = 0;
    std::int64_t bytes = 0;
  };
  [[nodiscard]] std::optional<File> look() const;
  [[nodiscard]] bool is_whole(const File& now) const;
  [[nodiscard]] Status compare();

  const std::filesystem::path path_;
  std::optional<File> file_;
  Status found_ = Done{};
};

}  // namespace terrella
