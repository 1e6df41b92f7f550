#include "streaming/preload/tile_plan.h"

#include <algorithm>
#include <utility>

#include "streaming/preload/block_walk.h"
#include "streaming/preload/projected_places.h"

namespace terrella {
namespace {

class RegionPlan : public TilePlan {
 public:
  RegionPlan(const TileGrid& grid, const Ellipsoid& ellipsoid, Region region, TileSpan levels,
             std::shared_ptr<const ProjectedPlaces> projected, TileRule rule)
      : grid_(grid), ellipsoid_(ellipsoid), region_(std::move(region)), projected_(std::move(projected)), rule_(rule) {
    for (auto level = static_cast<int>(levels.first); level <= levels.last; ++level) {
      BlockWalk walk = blocks(level);
      LevelCount count{level, 0};
      while (const auto block = walk.next()) count.tiles += block->count();
      counts_.push_back(count);
    }
  }
  [[nodiscard]] const std::vector<LevelCount>& counts() const override { return counts_; }
  [[nodiscard]] std::unique_ptr<TileFeed> walk() const override;
  [[nodiscard]] BlockWalk blocks(int level) const {
    return {grid_, ellipsoid_, region_, level, projected_.get(), rule_};
  }

 private:
  TileGrid grid_;
  Ellipsoid ellipsoid_;
  Region region_;
  std::shared_ptr<const ProjectedPlaces> projected_;
  TileRule rule_;
  std::vector<LevelCount> counts_;
};

class RegionFeed : public TileFeed {
 public:
  explicit RegionFeed(const RegionPlan& plan) : plan_(plan) {}
  [[nodiscard]] std::optional<TileRun> next() override {
    while (block_.columns.first > block_.columns.last) {
      if (!next_block()) return std::nullopt;
    }
    return TileRun{level_, block_.columns.first++, block_.rows.first, block_.rows.last};
  }

 private:
  bool next_block() {
    while (true) {
      if (walk_) {
        if (const auto block = walk_->next()) {
          block_ = *block;
          return true;
        }
      }
      if (levels_walked_ == plan_.counts().size()) return false;
      level_ = plan_.counts()[levels_walked_++].level;
      walk_.emplace(plan_.blocks(level_));
    }
  }

  const RegionPlan& plan_;
  std::size_t levels_walked_ = 0;
  int level_ = 0;
  std::optional<BlockWalk> walk_;
  TileBlock block_;
};

std::unique_ptr<TileFeed> RegionPlan::walk() const { return std::make_unique<RegionFeed>(*this); }

class ListPlan : public TilePlan {
 public:
  explicit ListPlan(std::vector<TileId> tiles) : tiles_(std::move(tiles)) {
    std::ranges::sort(tiles_);
    tiles_.erase(std::unique(tiles_.begin(), tiles_.end()), tiles_.end());
    for (const TileId& id : tiles_) {
      if (counts_.empty() || counts_.back().level != id.level) counts_.push_back({id.level, 0});
      ++counts_.back().tiles;
    }
  }
  [[nodiscard]] const std::vector<LevelCount>& counts() const override { return counts_; }
  [[nodiscard]] std::unique_ptr<TileFeed> walk() const override;
  [[nodiscard]] const std::vector<TileId>& tiles() const { return tiles_; }

 private:
  std::vector<TileId> tiles_;
  std::vector<LevelCount> counts_;
};

class ListFeed : public TileFeed {
 public:
  explicit ListFeed(const ListPlan& plan) : plan_(plan) {}
  [[nodiscard]] std::optional<TileRun> next() override {
    const std::vector<TileId>& tiles = plan_.tiles();
    if (at_ == tiles.size()) return std::nullopt;
    const TileId first = tiles[at_++];
    TileRun run{first.level, first.x, first.y, first.y};
    while (at_ < tiles.size() && tiles[at_] == TileId{run.level, run.x, run.last_y + 1}) {
      ++run.last_y;
      ++at_;
    }
    return run;
  }

 private:
  const ListPlan& plan_;
  std::size_t at_ = 0;
};

std::unique_ptr<TileFeed> ListPlan::walk() const { return std::make_unique<ListFeed>(*this); }

/// tiles · index / count, rounded down, without a product that could overflow.
std::int64_t part(std::int64_t tiles, std::int64_t index, std::int64_t count) {
  return tiles / count * index + tiles % count * index / count;
}

class ShardPlan : public TilePlan {
 public:
  ShardPlan(std::shared_ptr<const TilePlan> whole, const Shard& shard) : whole_(std::move(whole)) {
    for (const LevelCount& level : whole_->counts()) {
      const std::int64_t begin = part(level.tiles, shard.index - 1, shard.count);
      const std::int64_t end = part(level.tiles, shard.index, shard.count);
      counts_.push_back({level.level, end - begin});
      shares_.push_back({begin, end - 1});
    }
  }
  [[nodiscard]] const std::vector<LevelCount>& counts() const override { return counts_; }
  [[nodiscard]] std::unique_ptr<TileFeed> walk() const override;
  [[nodiscard]] const TilePlan& whole() const { return *whole_; }
  /// The part of a level, as positions in the order of the whole walk.
  [[nodiscard]] TileSpan share(int level) const {
    const auto at = std::ranges::find(counts_, level, &LevelCount::level);
    return shares_[static_cast<std::size_t>(at - counts_.begin())];
  }

 private:
  std::shared_ptr<const TilePlan> whole_;
  std::vector<LevelCount> counts_;
  std::vector<TileSpan> shares_;
};

class ShardFeed : public TileFeed {
 public:
  explicit ShardFeed(const ShardPlan& plan) : plan_(plan), feed_(plan.whole().walk()) {}
  [[nodiscard]] std::optional<TileRun> next() override {
    while (const auto run = feed_->next()) {
      if (run->level != level_) {
        level_ = run->level;
        passed_ = 0;
        share_ = plan_.share(level_);
      }
      const std::int64_t first = std::max<std::int64_t>(share_.first - passed_, 0);
      const std::int64_t last = std::min(share_.last - passed_, run->count() - 1);
      passed_ += run->count();
      if (first <= last) return TileRun{run->level, run->x, run->first_y + first, run->first_y + last};
    }
    return std::nullopt;
  }

 private:
  const ShardPlan& plan_;
  std::unique_ptr<TileFeed> feed_;
  int level_ = -1;
  TileSpan share_;
  std::int64_t passed_ = 0;
};

std::unique_ptr<TileFeed> ShardPlan::walk() const { return std::make_unique<ShardFeed>(*this); }

}  // namespace

std::int64_t TilePlan::total() const {
  std::int64_t sum = 0;
  for (const LevelCount& level : counts()) sum += level.tiles;
  return sum;
}

std::unique_ptr<TilePlan> plan_region(const TileGrid& grid, const Ellipsoid& ellipsoid, Region region, int first_level,
                                      int last_level, std::shared_ptr<const ProjectedPlaces> projected, TileRule rule) {
  const TileSpan levels{std::max(first_level, grid.min_level), std::min(last_level, grid.max_level)};
  return std::make_unique<RegionPlan>(grid, ellipsoid, std::move(region), levels, std::move(projected), rule);
}

std::unique_ptr<TilePlan> plan_list(std::vector<TileId> tiles) { return std::make_unique<ListPlan>(std::move(tiles)); }

std::unique_ptr<TilePlan> shard_of(std::shared_ptr<const TilePlan> whole, const Shard& shard) {
  return std::make_unique<ShardPlan>(std::move(whole), shard);
}

}  // namespace terrella
