#include "streaming/remote_tiff/remote_tiff.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

#include "streaming/raster/file_source.h"
#include "streaming/raster/rows/row_raster.h"
#include "streaming/remote/web_address.h"
#include "tiles/request_desk.h"

namespace terrella {
namespace {

/// Threads that look up blocks, keep answers and pass them on. One of them at most looks up, which may wait for the
/// network.
constexpr int kThreads = 3;
/// Spans of a wish with the number n have the numbers from n · kMostSpans on. A block has hundreds at most.
constexpr std::uint64_t kMostSpans = 1UL << 20;

using Encoded = Result<EncodedTile, TileFailure>;
using Bytes = std::shared_ptr<const std::vector<std::byte>>;

/// The bytes of a wanted block as they come.
struct WishedBlock {
  double priority = 0.0;
  std::vector<FilePiece> pieces{};             ///< those that are there
  std::map<std::uint64_t, ByteRange> spans{};  ///< in flight, by number
};

/// Lets spans that do not decode be requested again. An earlier version, or a fault of the disk, may have put them
/// there.
void doubt(RangeCache& cache, const std::vector<FilePiece>& pieces) {
  for (const FilePiece& piece : pieces) cache.doubt_span({.offset = piece.offset, .length = piece.bytes->size()});
}

class RemoteTiffSource : public RemoteTiff {
 public:
  RemoteTiffSource(std::shared_ptr<RemoteFile> file, std::unique_ptr<FileSource> tables,
                   std::unique_ptr<FileSource> decoder)
      : file_(std::move(file)),
        tables_(std::move(tables)),
        decoder_(std::move(decoder)),
        desk_({.work = [this](const TileWish& wish) { return look_up(wish); },
               .moved = [this](const TileWish& wish) { move(wish); },
               .ended = [this](const TileWish& wish, bool) { forget(wish.number); },
               .threads = kThreads,
               .beginners = 1}),
        answers_([this](HttpReply&& answer) {
          const std::uint64_t wish = answer.id / kMostSpans;
          desk_.resume(wish, [this, answer = std::move(answer)](const TileWish& asked) mutable {
            return keep(asked, std::move(answer));
          });
        }) {
    if (!file_->offline()) fetcher_ = std::make_unique<SpanFetcher>(file_->address(), file_->http(), answers_);
  }
  ~RemoteTiffSource() override {
    file_->stop();
    desk_.close();
  }

  [[nodiscard]] const RasterInfo& info() const override { return decoder_->info(); }
  [[nodiscard]] RemoteTiles* remote() override { return fetcher_ ? &desk_ : nullptr; }

  [[nodiscard]] Encoded read(const TileId& block) override {
    if (!has_block(info(), block)) return TileFailure{MissingKind::absent, {}};
    auto pieces = cached_pieces(block);
    if (!pieces) return pieces.error();
    return tile_of(block, *std::move(pieces));
  }

  [[nodiscard]] Result<double, TileFailure> value_at(std::int64_t column, std::int64_t row) override {
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

  [[nodiscard]] Result<std::vector<ByteRange>, TileFailure> spans(const TileId& block) override {
    auto found = tables_->spans(block);
    if (!found && file_->doubt_directories()) found = tables_->spans(block);
    if (found) file_->keep_directories();
    if (!found) {
      std::string fault = file_->take_fault();
      if (!fault.empty()) return TileFailure{MissingKind::failed, std::move(fault)};
      return unreadable(block, found.error().message);
    }
    std::vector<ByteRange> ranges;
    const std::uint64_t end = file_->held()->size();
    for (const ByteSpan& span : *found) {
      if (span.offset > end || span.size > end - span.offset) return unreadable(block, "its bytes lie beyond the end");
      ranges.push_back({.offset = span.offset, .length = span.size});
    }
    return ranges;
  }

  /// Bytes that do not decode may be due to a wrong table of tiles.
  [[nodiscard]] SpanCheck check_of(const TileId& block) override {
    return [this, block](const ByteRange& span, std::span<const std::byte> bytes) {
      const auto copy = std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
      const RemoteFile::Loan loan(*file_, {{span.offset, copy}});
      Status good = decoder_->check(block, {.offset = span.offset, .size = span.length});
      if (!good) static_cast<void>(file_->doubt_directories());
      return good;
    };
  }

 private:
  [[nodiscard]] TileFailure unreadable(const TileId& block, const std::string& why) const {
    return {MissingKind::broken,
            fmt::format("{}: block {}, {} of level {} cannot be read: {}; the file is truncated or damaged",
                        file_->name(), block.x, block.y, block.level, why)};
  }

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

  [[nodiscard]] WishedBlock& block_of(const TileWish& wish) {
    const std::lock_guard lock(mutex_);
    const auto [block, is_new] = blocks_.try_emplace(wish.number);
    if (is_new) block->second.priority = wish.priority;
    return block->second;
  }

  void move(const TileWish& wish) {
    const std::lock_guard lock(mutex_);
    WishedBlock& block = blocks_[wish.number];
    block.priority = wish.priority;
    for (const auto& [number, range] : block.spans) fetcher_->set_priority(number, wish.priority);
  }

  void forget(std::uint64_t wish) {
    const std::lock_guard lock(mutex_);
    const auto block = blocks_.extract(wish);
    if (block.empty()) return;
    for (const auto& [number, range] : block.mapped().spans) fetcher_->cancel(number);
  }

  // thread: the desk's ------------------------------------------------------------------------------------------------

  /// Takes the bytes that the cache has, and asks for the others. Waits for the network or the cache.
  std::optional<Encoded> look_up(const TileWish& wish) {
    WishedBlock& block = block_of(wish);
    const auto ranges = spans(wish.id);
    if (!ranges) return ranges.error();
    std::vector<ByteRange> missing;
    for (const ByteRange& range : *ranges) {
      auto bytes = cached(range);
      if (!bytes) missing.push_back(range);
      if (bytes) block.pieces.push_back({range.offset, std::move(bytes)});
    }
    if (missing.empty()) return tile_of(wish.id, std::move(block.pieces));
    if (!desk_.is_wanted(wish.number)) return std::nullopt;
    const std::lock_guard lock(mutex_);
    for (std::uint64_t number = wish.number * kMostSpans; const ByteRange& range : missing) {
      block.spans.emplace(number, range);
      fetcher_->fetch(number++, range, block.priority, check_of(wish.id));
    }
    return std::nullopt;
  }

  /// Takes the bytes that came.
  std::optional<Encoded> keep(const TileWish& wish, HttpReply&& answer) {
    if (answer.outcome != HttpOutcome::content) {
      if (answer.status == 412) file_->doubt_version();
      const bool broken = answer.outcome == HttpOutcome::broken;
      return TileFailure{broken ? MissingKind::broken : MissingKind::failed, std::move(answer.why)};
    }
    WishedBlock& block = block_of(wish);
    ByteRange range;
    bool complete = false;
    {
      const std::lock_guard lock(mutex_);
      range = block.spans.extract(answer.id).mapped();
      complete = block.spans.empty();
    }
    const auto bytes = std::make_shared<const std::vector<std::byte>>(std::move(answer.body));
    block.pieces.push_back({range.offset, bytes});
    if (file_->cache() != nullptr && !answer.no_store) file_->cache()->keep_span(range, *bytes);
    if (!complete) return std::nullopt;
    return tile_of(wish.id, std::move(block.pieces));
  }

  const std::shared_ptr<RemoteFile> file_;
  const std::unique_ptr<FileSource> tables_;               ///< looks up the bytes of blocks, waiting for the network
  const std::unique_ptr<FileSource> decoder_;              ///< decodes the blocks whose bytes are there
  std::mutex mutex_;                                       ///< guards blocks_
  std::unordered_map<std::uint64_t, WishedBlock> blocks_;  ///< by the wish's number
  RequestDesk desk_;
  ReplyQueue answers_;
  std::unique_ptr<SpanFetcher> fetcher_;  ///< null: offline. The last member, because it calls the others
};

}  // namespace

Result<std::unique_ptr<RemoteTiff>> RemoteTiff::make(std::shared_ptr<RemoteFile> file,
                                                     std::shared_ptr<const RasterFile> raster, const CrsPlace& place,
                                                     const RasterOptions& options) {
  if (!raster->header().whole().has_blocks()) return no_blocks(*raster);
  auto tables = make_file_source(std::move(raster), place, options);
  if (!tables) {
    const std::string fault = file->take_fault();
    return fault.empty() ? tables.error() : Error{fault};
  }
  auto decoder = (*tables)->over(file->held());
  return std::unique_ptr<RemoteTiff>(
      std::make_unique<RemoteTiffSource>(std::move(file), *std::move(tables), std::move(decoder)));
}

bool is_tiff_address(const Url& tile_set) {
  const auto address = parse_address(tile_set);
  if (!address || tile_set.with_secrets().find('{') != std::string::npos) return false;
  const std::string path = lower_case(address->path);
  return (address->scheme == "http" || address->scheme == "https") &&
         (path.ends_with(".tif") || path.ends_with(".tiff"));
}

Result<std::shared_ptr<const RasterFile>> open_remote_raster(RemoteFile& file) {
  auto opened = RasterFile::open(file.fetching());
  std::string fault = file.take_fault();
  if (!opened && fault.empty() && file.doubt_directories()) {
    opened = RasterFile::open(file.fetching());
    fault = file.take_fault();
  }
  if (!fault.empty()) return Error{fault};
  if (!opened) return opened;
  file.keep_directories();
  return (*opened)->in_strip_blocks();
}

Error no_blocks(const RasterFile& file) {
  const RasterShape& picture = file.header().whole();
  return Error{fmt::format(
      "{}: its picture is stored in strips of {}x{} pixels, and parts of it are read over a network only if 128 rows "
      "of strips have at most {} MiB; download the file and open that, or put a tiled one in its place (gdal_translate "
      "-of COG IN.tif OUT.tif)",
      file.name(), picture.width_px, picture.rows_per_strip, kMostStripBlockBytes >> 20)};
}

}  // namespace terrella
