#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "base/result.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A text file with a line for each of many tiles, which begins with LEVEL/X/Y. thread: one at a time
class TileListFile {
 public:
  enum class Mode { begin, append };  ///< begin: an earlier list of that name is replaced

  /// `path` empty: the lines go nowhere. A file that is there and is no such list is refused. The error names the path.
  [[nodiscard]] static Result<TileListFile> open(const std::filesystem::path& path, Mode mode);

  /// The line is in the file when this returns; if it cannot be written close() tells.
  void add(const TileId& id, const std::string& rest = {});
  /// An error if any line could not be written.
  [[nodiscard]] Status close();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  void note_failure();

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  bool failed_ = false;
  int error_number_ = 0;  ///< of the first failure
};

}  // namespace terrella
