#include "streaming/remote_tiff/range_plan.h"

#include <set>
#include <utility>

#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

class RangeOrigin : public TileOrigin {
 public:
  RangeOrigin(const FileAddress& file, std::shared_ptr<RemoteTiff> raster, const HttpOptions& options,
              std::shared_ptr<const SpanList> spans, ReplyQueue& answers)
      : raster_(std::move(raster)), spans_(std::move(spans)), fetcher_(file, options, answers) {}

  void ask(TileQuestion question) override {
    const PlannedSpan& span = spans_->at(question.id);
    fetcher_.fetch(question.number, span.range, 0.0, raster_->check_of(span.block));
  }
  void withdraw(std::uint64_t number) override { fetcher_.cancel(number); }
  [[nodiscard]] HttpCounts counts() const override { return fetcher_.counts(); }

 private:
  const std::shared_ptr<RemoteTiff> raster_;
  const std::shared_ptr<const SpanList> spans_;
  SpanFetcher fetcher_;
};

}  // namespace

Result<SpanList> spans_of_tiles(RemoteTiff& raster, const WarpFigure& figure, const TileGrid& grid,
                                const TilePlan& tiles, const std::function<bool()>& go_on) {
  const auto planner = TilePlanner::open(raster.info(), figure, grid, Overviews::made);
  if (!planner) return planner.error();
  const std::vector<WarpLevel>& levels = (*planner)->frame().levels;
  std::set<TileId> blocks;
  const auto feed = tiles.walk();
  for (auto run = feed->next(); run; run = feed->next()) {
    for (std::int64_t y = run->first_y; y <= run->last_y; ++y) {
      if (!go_on()) return Error{"stopped before the tiles were found"};
      const auto plan = (*planner)->plan({.level = run->level, .x = run->x, .y = y});
      if (!plan) return Error{plan.error().why};
      for (const WarpPiece& piece : plan->pieces) {
        const int stored = levels[static_cast<std::size_t>(piece.id.level)].stored;
        blocks.insert({.level = stored, .x = piece.id.x, .y = piece.id.y});
      }
    }
  }
  SpanList spans;
  for (const TileId& block : blocks) {
    const auto found = raster.spans(block);
    if (!found) return Error{found.error().why};
    for (const ByteRange& span : *found) spans.emplace(RangeCache::span_id(span), PlannedSpan{span, block});
  }
  return spans;
}

std::unique_ptr<TileOrigin> range_origin(const FileAddress& file, std::shared_ptr<RemoteTiff> raster,
                                         const HttpOptions& options, std::shared_ptr<const SpanList> spans,
                                         ReplyQueue& answers) {
  return std::make_unique<RangeOrigin>(file, std::move(raster), options, std::move(spans), answers);
}

}  // namespace terrella
