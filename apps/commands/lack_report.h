#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/setup/tile_list_file.h"
#include "base/result.h"
#include "streaming/preload/preloader.h"

namespace terrella {

/// "broken", "refused", "failed", "no room".
[[nodiscard]] const char* lack_name(Lack kind);

/// Tiles that a preload could not bring, by reason, and one by one in a file. thread: one at a time
class LackReport {
 public:
  struct Group {
    Lack kind = Lack::failed;
    std::string why;  ///< without the address
    std::int64_t tiles = 0;
    TileId first;
  };

  /// `file`: where each tile gets a line `LEVEL/X/Y<TAB>kind<TAB>why`; empty: nowhere.
  [[nodiscard]] static Result<LackReport> open(const std::filesystem::path& file);

  void add(const TileId& id, Lack kind, const std::string& told);
  /// Most tiles first; reasons beyond the first hundred different ones stand as one.
  [[nodiscard]] std::vector<Group> groups() const;
  /// Fails if the file could not be written.
  [[nodiscard]] Status close() { return list_.close(); }

 private:
  TileListFile list_;
  std::map<std::pair<Lack, std::string>, Group> groups_;
};

}  // namespace terrella
