#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/serve/served_set.h"
#include "apps/serve/web_request.h"

namespace terrella {

/// Answers requests for the tiles and descriptions of sets (README.md has the paths). It opens no file by a request's
/// path: a path only chooses among the sets and their tiles. thread: any, several at once
class TileServer {
 public:
  /// Takes what goes wrong with a set, a line at a time, without secrets. thread: any, several at once
  using Log = std::function<void(const std::string& line)>;
  /// Failures after this many are not logged: a request can be repeated for ever.
  static constexpr int kMostLogged = 1000;

  TileServer(std::vector<ServedSet> sets, Log log) : sets_(std::move(sets)), log_(std::move(log)) {}

  [[nodiscard]] WebAnswer answer(const WebRequest& request) const;
  [[nodiscard]] const std::vector<ServedSet>& sets() const { return sets_; }

 private:
  using Parts = std::span<const std::string_view>;
  /// Place of a tile as an address names it: its zoom, column and row, and the way that rows are counted.
  struct AskedTile {
    std::string_view zoom, column, row;
    bool rows_from_south = false;
  };

  [[nodiscard]] WebAnswer get(const WebRequest& request) const;
  [[nodiscard]] WebAnswer get_of_set(const ServedSet& set, Parts parts, const WebRequest& request) const;
  [[nodiscard]] WebAnswer get_of_wmts(const ServedSet& set, Parts parts, const WebRequest& request) const;
  [[nodiscard]] WebAnswer key_value_pairs(const std::map<std::string, std::string>& pairs,
                                          const WebRequest& request) const;
  [[nodiscard]] WebAnswer archive(const ServedSet& set, const WebRequest& request) const;
  [[nodiscard]] WebAnswer tile(const ServedSet& set, const AskedTile& asked, const WebRequest& request) const;
  [[nodiscard]] WebAnswer read(const ServedSet& set, const TileId& id, std::string_view if_none_match) const;
  [[nodiscard]] WebAnswer failed(const ServedSet& set, const TileId& id, const TileFailure& failure) const;
  [[nodiscard]] const ServedSet* find(std::string_view name) const;

  const std::vector<ServedSet> sets_;
  const Log log_;
  mutable std::atomic<int> logged_ = 0;
};

}  // namespace terrella
