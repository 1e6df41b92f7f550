#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/viewer/feature_list/feature_table.h"

namespace terrella {

/// The rows of a table that have a text, in an order. Searches step by step, so that a frame need not wait for a long
/// table. thread: any, but one call at a time
class FeatureFilter {
 public:
  /// Begins a search. `text`: as typed; blank: all rows are found. `descending` turns the order round, but rows without
  /// a value stay last. found() keeps the rows before until the search has ended.
  void begin(const SortOrder& order, bool descending, const std::string& text);
  /// The same, in the order of the last search. If the text contains the last one, only the found rows are searched.
  void narrow(const SortOrder& order, bool descending, const std::string& text);
  /// Looks at up to `most` rows of the table that the search began with. True if the search ends with them.
  bool step(const FeatureTable& table, std::size_t most);
  [[nodiscard]] bool is_busy() const { return busy_; }
  /// Row numbers that the last search has found.
  [[nodiscard]] const std::vector<std::uint32_t>& found() const { return found_; }

 private:
  void search(std::vector<std::uint32_t> rows, std::string text);

  std::string text_;  ///< folded
  std::vector<std::uint32_t> rows_, coming_, found_;
  std::size_t next_ = 0;  ///< index in `rows_`
  bool busy_ = false;
};

}  // namespace terrella
