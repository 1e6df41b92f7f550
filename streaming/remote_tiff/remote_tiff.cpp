#include "streaming/remote_tiff/remote_tiff.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <utility>

#include "streaming/raster/rows/row_raster.h"
#include "streaming/raster/tiff_source.h"
#include "streaming/remote_tiff/remote_pyramid.h"
#include "tiles/late_workers.h"

namespace terrella {
namespace {

/// Threads that take answers, keep them and pass them on, which may make a picture of them.
constexpr int kTakers = 2;

using Encoded = Result<EncodedTile, TileFailure>;
using Bytes = std::shared_ptr<const std::vector<std::byte>>;

/// A block that is wanted, and its bytes as they come.
struct Wish {
  double priority = 0.0;
  RemoteTiles::Done done;
  bool looked_up = false;
  std::vector<FilePiece> pieces{};       ///< those that came
  std::vector<std::uint64_t> numbers{};  ///< numbers of the spans that are in flight
};

/// Lets spans that do not decode be requested again. An earlier version, or a fault of the disk, may have put them
/// there.
void doubt(RangeCache& cache, const std::vector<FilePiece>& pieces) {
  for (const FilePiece& piece : pieces) cache.doubt_span({.offset = piece.offset, .length = piece.bytes->size()});
}

/// The threads of a raster, and the data that they use.
class RemoteTiffDesk : public RemoteTiles {
 public:
  RemoteTiffDesk(std::shared_ptr<RemoteFile> file, std::unique_ptr<TiffSource> tables,
                 std::unique_ptr<TiffSource> decoder)
      : file_(std::move(file)), tables_(std::move(tables)), decoder_(std::move(decoder)) {
    if (file_->offline()) return;
    fetcher_ = std::make_unique<SpanFetcher>(file_->address(), file_->http(), answers_);
    threads_.emplace_back([this] { look_up_wishes(); });
    for (int i = 0; i < kTakers; ++i) {
      threads_.emplace_back([this] {
        while (auto answer = answers_.take()) take(*std::move(answer));
      });
    }
  }
  ~RemoteTiffDesk() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    file_->stop();
    wished_.notify_all();
    answers_.close();
    threads_.clear();
  }

  [[nodiscard]] const RasterInfo& info() const { return decoder_->info(); }
  [[nodiscard]] const std::vector<std::jthread>& threads() const { return threads_; }
  [[nodiscard]] RemoteTiles* remote() { return fetcher_ ? this : nullptr; }

  [[nodiscard]] Encoded read(const TileId& block) {
    if (!has_block(info(), block)) return TileFailure{MissingKind::absent, {}};
    auto pieces = cached_pieces(block);
    if (!pieces) return pieces.error();
    return tile_of(block, *std::move(pieces));
  }

  [[nodiscard]] Result<double, TileFailure> value_at(std::int64_t column, std::int64_t row) {
    const RasterLevel& finest = info().levels.back();
    const TileId block{.level = static_cast<int>(info().levels.size()) - 1,
                       .x = column / finest.block_width_px,
                       .y = row / finest.block_height_px};
    if (column < 0 || row < 0 || !has_block(info(), block)) return TileFailure{MissingKind::absent, {}};
    auto pieces = cached_pieces(block);
    if (!pieces) return pieces.error();
    const RemoteFile::Loan loan(*file_, *std::move(pieces));
    return decoder_->value_at(column, row);
  }

  [[nodiscard]] Result<std::vector<ByteRange>, TileFailure> spans(const TileId& block) {
    auto found = tables_->spans(block);
    if (!found && file_->doubt_directories()) found = tables_->spans(block);
    if (found) file_->keep_directories();
    if (!found) {
      std::string fault = file_->take_fault();
      if (!fault.empty()) return TileFailure{MissingKind::failed, std::move(fault)};
      return TileFailure{
          MissingKind::broken,
          fmt::format("{}: block {}, {} of level {} cannot be read: {}; the file is truncated or damaged",
                      file_->name(), block.x, block.y, block.level, found.error().message)};
    }
    std::vector<ByteRange> ranges;
    for (const ByteSpan& span : *found) ranges.push_back({.offset = span.offset, .length = span.size});
    return ranges;
  }

  /// Bytes that do not decode may be due to a wrong table of tiles.
  [[nodiscard]] SpanCheck check_of(const TileId& block) {
    return [this, block](const ByteRange& span, std::span<const std::byte> bytes) {
      Status good = decoder_->check(block, {.offset = span.offset, .size = span.length}, bytes);
      if (!good) static_cast<void>(file_->doubt_directories());
      return good;
    };
  }

  void fetch(const TileId& block, double priority, Done done) override {
    {
      const std::lock_guard lock(mutex_);
      wishes_.insert_or_assign(block, std::make_shared<Wish>(Wish{.priority = priority, .done = std::move(done)}));
    }
    wished_.notify_one();
  }

  void set_priority(const TileId& block, double priority) override {
    const std::lock_guard lock(mutex_);
    const auto wish = wishes_.find(block);
    if (wish == wishes_.end()) return;
    wish->second->priority = priority;
    for (const std::uint64_t number : wish->second->numbers) fetcher_->set_priority(number, priority);
  }

  void cancel(const TileId& block) override {
    const std::lock_guard lock(mutex_);
    static_cast<void>(forget(block));
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  [[nodiscard]] Bytes cached(const ByteRange& span) {
    if (file_->cache() == nullptr) return nullptr;
    auto bytes = file_->cache()->find_span(span);
    return bytes ? std::make_shared<const std::vector<std::byte>>(*std::move(bytes)) : nullptr;
  }

  /// All bytes of a block, if no request is needed for them.
  [[nodiscard]] Result<std::vector<FilePiece>, TileFailure> cached_pieces(const TileId& block) {
    const TileFailure elsewhere = file_->offline() ? TileFailure{MissingKind::absent, "it is not in the cache"}
                                                   : TileFailure{MissingKind::remote, {}};
    const auto found = decoder_->spans(block);
    if (!found) return elsewhere;
    std::vector<FilePiece> pieces;
    for (const ByteSpan& span : *found) {
      auto bytes = cached({.offset = span.offset, .length = span.size});
      if (!bytes) return elsewhere;
      pieces.push_back({span.offset, std::move(bytes)});
    }
    return pieces;
  }

  /// The block's picture or numbers, made of its bytes by the reader of files.
  [[nodiscard]] Encoded tile_of(const TileId& block, std::vector<FilePiece> pieces) {
    auto inner = decoder_->read(block);
    if (!inner) return inner.error();
    EncodedTile tile;
    const auto lend = [file = file_, pieces = std::move(pieces)](const auto& make) {
      return [file, pieces, make] {
        const RemoteFile::Loan loan(*file, pieces);
        auto made = make();
        if (!made && file->cache() != nullptr) doubt(*file->cache(), pieces);
        return made;
      };
    };
    if (inner->make_picture) tile.make_picture = lend(inner->make_picture);
    if (inner->make_numbers) tile.make_numbers = lend(inner->make_numbers);
    return tile;
  }

  /// Takes a wish away with its requests. The lock is held.
  std::shared_ptr<Wish> forget(const TileId& block) {
    auto found = wishes_.extract(block);
    if (found.empty()) return nullptr;
    for (const std::uint64_t number : found.mapped()->numbers) {
      fetcher_->cancel(number);
      asked_.erase(number);
    }
    return std::move(found.mapped());
  }

  // thread: look-up ---------------------------------------------------------------------------------------------------

  void look_up_wishes() {
    Lock lock(mutex_);
    for (;;) {
      auto next = wishes_.end();
      const auto is_next = [&] {
        next = wishes_.end();
        for (auto wish = wishes_.begin(); wish != wishes_.end(); ++wish) {
          if (wish->second->looked_up) continue;
          if (next == wishes_.end() || wish->second->priority > next->second->priority) next = wish;
        }
        return stopping_ || next != wishes_.end();
      };
      wished_.wait(lock, is_next);
      if (stopping_) return;
      const auto [block, wish] = *next;
      wish->looked_up = true;
      look_up(lock, block, wish);
    }
  }

  /// Gives up the lock while it waits for the network or the cache.
  void look_up(Lock& lock, const TileId& block, const std::shared_ptr<Wish>& wish) {
    lock.unlock();
    const auto ranges = spans(block);
    std::vector<FilePiece> pieces;
    std::vector<ByteRange> missing;
    for (const ByteRange& range : ranges ? *ranges : std::vector<ByteRange>()) {
      auto bytes = cached(range);
      if (!bytes) missing.push_back(range);
      if (bytes) pieces.push_back({range.offset, std::move(bytes)});
    }
    lock.lock();
    const auto found = wishes_.find(block);
    if (found == wishes_.end() || found->second != wish) return;
    wish->pieces = std::move(pieces);
    if (ranges && !missing.empty()) {
      for (const ByteRange& range : missing) {
        wish->numbers.push_back(++last_number_);
        asked_.emplace(last_number_, Asked{block, range});
        fetcher_->fetch(last_number_, range, wish->priority, check_of(block));
      }
      return;
    }
    static_cast<void>(forget(block));
    lock.unlock();
    wish->done(ranges ? tile_of(block, std::move(wish->pieces)) : Encoded(ranges.error()));
    lock.lock();
  }

  // thread: taker -----------------------------------------------------------------------------------------------------

  void take(HttpReply&& answer) {
    Lock lock(mutex_);
    const auto number = asked_.extract(answer.id);
    if (number.empty()) return;
    const Asked asked = number.mapped();
    const std::shared_ptr<Wish> wish = wishes_.at(asked.block);
    std::erase(wish->numbers, answer.id);
    if (answer.outcome != HttpOutcome::content) {
      static_cast<void>(forget(asked.block));
      lock.unlock();
      if (answer.status == 412) file_->doubt_version();
      const bool broken = answer.outcome == HttpOutcome::broken;
      return wish->done(TileFailure{broken ? MissingKind::broken : MissingKind::failed, std::move(answer.why)});
    }
    const auto bytes = std::make_shared<const std::vector<std::byte>>(std::move(answer.body));
    wish->pieces.push_back({asked.range.offset, bytes});
    const bool complete = wish->numbers.empty();
    if (complete) wishes_.erase(asked.block);
    lock.unlock();
    if (file_->cache() != nullptr && !answer.no_store) file_->cache()->keep_span(asked.range, *bytes);
    if (complete) wish->done(tile_of(asked.block, std::move(wish->pieces)));
  }

  struct Asked {
    TileId block;
    ByteRange range;
  };

  const std::shared_ptr<RemoteFile> file_;
  const std::unique_ptr<TiffSource> tables_;   ///< looks up the bytes of blocks, waiting for the network
  const std::unique_ptr<TiffSource> decoder_;  ///< decodes the blocks whose bytes are there
  std::mutex mutex_;                           ///< guards what follows
  std::condition_variable wished_;
  bool stopping_ = false;
  std::map<TileId, std::shared_ptr<Wish>> wishes_;
  std::unordered_map<std::uint64_t, Asked> asked_;
  std::uint64_t last_number_ = 0;
  ReplyQueue answers_;
  std::unique_ptr<SpanFetcher> fetcher_;  ///< null: offline
  std::vector<std::jthread> threads_;     ///< last: use the rest
};

class RemoteTiffSource : public RemoteTiff {
 public:
  explicit RemoteTiffSource(std::unique_ptr<RemoteTiffDesk> desk) : desk_(std::move(desk)) {}
  ~RemoteTiffSource() override { end_owner(std::move(desk_)); }

  [[nodiscard]] const RasterInfo& info() const override { return desk_->info(); }
  [[nodiscard]] RemoteTiles* remote() override { return desk_->remote(); }
  [[nodiscard]] Encoded read(const TileId& block) override { return desk_->read(block); }
  [[nodiscard]] Result<double, TileFailure> value_at(std::int64_t column, std::int64_t row) override {
    return desk_->value_at(column, row);
  }
  [[nodiscard]] Result<std::vector<ByteRange>, TileFailure> spans(const TileId& block) override {
    return desk_->spans(block);
  }
  [[nodiscard]] SpanCheck check_of(const TileId& block) override { return desk_->check_of(block); }

 private:
  std::unique_ptr<RemoteTiffDesk> desk_;
};

}  // namespace

Result<std::unique_ptr<RemoteTiff>> RemoteTiff::make(std::shared_ptr<RemoteFile> file, TiffPyramid pyramid,
                                                     const CrsPlace& place, const RasterOptions& options) {
  if (!pyramid.whole().has_blocks()) return no_blocks(file->name(), pyramid);
  auto tables = make_tiff_source(std::move(pyramid), file->name(), place, options);
  if (!tables) {
    const std::string fault = file->take_fault();
    return fault.empty() ? tables.error() : Error{fault};
  }
  auto decoder = (*tables)->over(file->held());
  return std::unique_ptr<RemoteTiff>(std::make_unique<RemoteTiffSource>(
      std::make_unique<RemoteTiffDesk>(std::move(file), *std::move(tables), std::move(decoder))));
}

}  // namespace terrella
