#include "apps/viewer/feature_list/feature_filter.h"

#include <algorithm>
#include <utility>

#include "apps/viewer/tools/folded_text.h"

namespace terrella {

void FeatureFilter::search(std::vector<std::uint32_t> rows, std::string text) {
  text_ = std::move(text);
  rows_ = std::move(rows);
  coming_.clear();
  next_ = 0;
  busy_ = true;
}

void FeatureFilter::begin(const SortOrder& order, bool descending, const std::string& text) {
  std::vector<std::uint32_t> rows = order.rows;
  if (descending) std::reverse(rows.begin(), rows.end() - std::ptrdiff_t(order.blank));
  search(std::move(rows), folded(text));
}

void FeatureFilter::narrow(const SortOrder& order, bool descending, const std::string& text) {
  std::string sought = folded(text);
  if (busy_ || sought.find(text_) == std::string::npos) return begin(order, descending, text);
  search(found_, std::move(sought));
}

bool FeatureFilter::step(const FeatureTable& table, std::size_t most) {
  if (!busy_) return false;
  const std::size_t end = std::min(rows_.size(), next_ + most);
  for (; next_ < end; ++next_) {
    if (table.folded[rows_[next_]].find(text_) != std::string::npos) coming_.push_back(rows_[next_]);
  }
  if (next_ < rows_.size()) return false;
  found_ = std::move(coming_);
  busy_ = false;
  return true;
}

}  // namespace terrella
