#include "streaming/remote_tiff/waiting_raster.h"

#include <chrono>
#include <deque>
#include <future>
#include <map>
#include <mutex>
#include <utility>

#include "streaming/raster/row_raster.h"

namespace terrella {
namespace {

/// Blocks that are fetched together with the one that is read. In a COG they lie one after the other.
constexpr std::int64_t kBlocksAhead = 16;
constexpr std::size_t kKeptAnswers = 512;
constexpr std::chrono::milliseconds kBetweenLooks{100};

class WaitingRaster : public RasterSource {
 public:
  WaitingRaster(std::unique_ptr<RasterSource> raster, std::function<bool()> go_on)
      : go_on_(std::move(go_on)), raster_(std::move(raster)) {}
  [[nodiscard]] const RasterInfo& info() const override { return raster_->info(); }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override {
    auto there = raster_->read(block);
    if (there || there.error().kind != MissingKind::remote) return there;
    const std::shared_future<Encoded> answer = ask(block);
    for (TileId next = block; ++next.x < block.x + kBlocksAhead && has_block(info(), next);) {
      static_cast<void>(ask(next));
    }
    while (answer.wait_for(kBetweenLooks) != std::future_status::ready) {
      if (!go_on_()) return TileFailure{MissingKind::failed, "stopped before the server answered"};
    }
    return answer.get();
  }

 private:
  using Encoded = Result<EncodedTile, TileFailure>;

  std::shared_future<Encoded> ask(const TileId& block) {
    auto promise = std::make_shared<std::promise<Encoded>>();
    const std::shared_future<Encoded> answer = promise->get_future().share();
    {
      const std::lock_guard lock(mutex_);
      const auto [known, is_new] = answers_.emplace(block, answer);
      if (!is_new) return known->second;
      order_.push_back(block);
      drop_old();
    }
    // Earlier rows first.
    raster_->remote()->fetch(block, -static_cast<double>(block.y),
                             [promise](Encoded came) { promise->set_value(std::move(came)); });
    return answer;
  }

  /// Drops the oldest answers that have come. The lock is held.
  void drop_old() {
    while (order_.size() > kKeptAnswers &&
           answers_.at(order_.front()).wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
      answers_.erase(order_.front());
      order_.pop_front();
    }
  }

  const std::function<bool()> go_on_;
  std::mutex mutex_;  ///< guards what follows
  std::map<TileId, std::shared_future<Encoded>> answers_;
  std::deque<TileId> order_;  ///< the oldest first
  const std::unique_ptr<RasterSource> raster_;
};

}  // namespace

std::unique_ptr<RasterSource> waiting_raster(std::unique_ptr<RasterSource> raster, std::function<bool()> go_on) {
  return std::make_unique<WaitingRaster>(std::move(raster), std::move(go_on));
}

}  // namespace terrella
