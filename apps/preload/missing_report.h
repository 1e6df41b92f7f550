#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/process/tile_list_file.h"
#include "base/result.h"
#include "streaming/preload/preloader.h"

namespace terrella {

/// Name of a reason: "broken", "refused", "failed" or "no room".
[[nodiscard]] const char* missing_name(PreloadMissing kind);

/// Missing tiles of a preload, grouped by reason and listed one by one in a file. thread: one at a time
class MissingReport {
 public:
  struct Group {
    PreloadMissing kind = PreloadMissing::failed;
    std::string why;  ///< without the address
    std::int64_t tiles = 0;
    TileId first;
  };

  /// Opens the list. Each tile adds a line `LEVEL/X/Y<TAB>kind<TAB>why` to `file`; an empty name writes no list.
  [[nodiscard]] static Result<MissingReport> open(const std::filesystem::path& file);

  void add(const TileId& id, PreloadMissing kind, const std::string& told);
  /// Groups sorted by tile count, largest first. All reasons beyond the first hundred share one group.
  [[nodiscard]] std::vector<Group> groups() const;
  /// Closes the list; fails if the file could not be written.
  [[nodiscard]] Status close() { return list_.close(); }

 private:
  TileListFile list_;
  std::map<std::pair<PreloadMissing, std::string>, Group> groups_;
};

}  // namespace terrella
