#include "streaming/preload/wanted_tiles.h"

#include <algorithm>
#include <utility>

namespace terrella {
namespace {

constexpr std::int64_t kMostAtOnce = 4096;

}  // namespace

std::int64_t unix_now_s() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(since).count();
}

WantedTiles::WantedTiles(const TilePlan& plan, TileCache& cache, std::optional<std::chrono::seconds> refresh_older_than)
    : cache_(cache), feed_(plan.walk()), refresh_older_than_(refresh_older_than), now_unix_s_(unix_now_s()) {}

Result<std::optional<WantedTileRecord>> WantedTiles::next() {
  const std::int64_t before = there_;
  while (at_ == found_.size()) {
    if (done_ || there_ - before >= kMostAtOnce) return std::optional<WantedTileRecord>();
    if (const Status looked = look(); !looked) return looked.error();
  }
  return std::optional(std::move(found_[at_++]));
}

Status WantedTiles::look() {
  found_.clear();
  at_ = 0;
  if (run_.count() <= 0) {
    const auto run = feed_->next();
    if (!run) {
      done_ = true;
      return Done{};
    }
    run_ = *run;
  }
  const std::int64_t last_y = std::min(run_.last_y, run_.first_y + kMostAtOnce - 1);
  std::int64_t next_y = run_.first_y;
  const auto unknown_until = [&](std::int64_t y) {
    for (; next_y < y; ++next_y)
      found_.push_back({.id = {run_.level, run_.x, next_y}, .etag = {}, .last_modified = {}});
  };
  const Status looked =
      cache_.peek_column(run_.level, run_.x, run_.first_y, last_y, [&](std::int64_t y, const CacheRecord& record) {
        unknown_until(y);
        ++next_y;
        const bool up_to_date = is_up_to_date(record);
        if (record.pinned || (up_to_date && record.missing)) ++settled_;
        if (up_to_date) {
          ++there_;
          return;
        }
        const bool have = !record.missing;
        found_.push_back({{run_.level, run_.x, y}, have, have ? record.etag : "", have ? record.last_modified : ""});
      });
  if (!looked) return looked.error();
  unknown_until(last_y + 1);
  run_.first_y = last_y + 1;
  return Done{};
}

bool WantedTiles::is_up_to_date(const CacheRecord& record) const {
  if (record.missing == MissingKind::broken || record.missing == MissingKind::failed) return false;
  if (refresh_older_than_) return now_unix_s_ - record.stored_unix_s < refresh_older_than_->count();
  return is_fresh(record, now_unix_s_);
}

}  // namespace terrella
