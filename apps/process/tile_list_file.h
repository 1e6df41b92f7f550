#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "base/result.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A text file with one line per tile; each line begins with LEVEL/X/Y. thread: one at a time
class TileListFile {
 public:
  enum class Mode { begin, append };  ///< begin: replaces an earlier list of that name

  /// Opens the list; an empty `path` discards all lines. An existing file of another kind is refused. The error names
  /// the path.
  [[nodiscard]] static Result<TileListFile> open(const std::filesystem::path& path, Mode mode);

  /// Writes the line to the file before returning. close() reports failures.
  void add(const TileId& id, const std::string& rest = {});
  /// Fails if any line could not be written.
  [[nodiscard]] Status close();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  void note_failure();

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  bool failed_ = false;
  int error_number_ = 0;  ///< errno of the first failure
};

}  // namespace terrella
