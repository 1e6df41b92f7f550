#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// A stored view of the user.
struct Bookmark {
  Camera camera;
  std::string name = {};   ///< UTF-8; empty: none given
  std::string place = {};  ///< name of the place in the middle of the view, UTF-8; empty: none is known
};

/// Numbered views of the user with names, kept in a file between runs. thread: one
class Bookmarks {
 public:
  static constexpr int kMost = 99;
  static constexpr int kKeys = 9;  ///< the first have keys

  /// Loads a file; a missing file gives no bookmarks. Fails if the file cannot be read or has another format. Invalid
  /// cameras are skipped.
  [[nodiscard]] static Result<Bookmarks> load(const std::filesystem::path& file);
  /// Saves the bookmarks and creates the folder if needed. Overwrites changes that another run has saved since. The
  /// error names the file.
  [[nodiscard]] Status save(const std::filesystem::path& file) const;

  /// `number` in [1, kMost].
  [[nodiscard]] std::optional<Camera> at(int number) const;
  /// Stores a view and its place; a name that the number has stays.
  void set(int number, const Camera& camera, std::string place = {});
  void rename(int number, std::string name);
  void remove(int number) { bookmarks_.erase(number); }
  /// Exchanges two numbers; one of them may be empty.
  void exchange(int number, int other);
  /// The lowest number without a bookmark; nullopt if all are taken.
  [[nodiscard]] std::optional<int> free_number() const;
  /// All bookmarks by number.
  [[nodiscard]] const std::map<int, Bookmark>& all() const { return bookmarks_; }

 private:
  std::map<int, Bookmark> bookmarks_;
};

/// Returns bookmarks.json in $XDG_CONFIG_HOME/terrella or ~/.config/terrella, or bookmarks-mars.json and the like for
/// other bodies than the Earth; nullopt if neither folder is known.
[[nodiscard]] std::optional<std::filesystem::path> bookmarks_file(const std::string& body);

}  // namespace terrella
