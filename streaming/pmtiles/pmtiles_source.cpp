#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>

#include "streaming/file_bytes.h"
#include "streaming/pmtiles/pmtiles_set.h"
#include "streaming/pmtiles/tile_number.h"
#include "streaming/tile_lister.h"

namespace terrella {
namespace {

/// A file that several threads read at once.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path) : descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  [[nodiscard]] std::optional<std::uint64_t> size() const {
    struct stat facts {};
    if (fstat(descriptor_, &facts) != 0) return std::nullopt;
    return static_cast<std::uint64_t>(facts.st_size);
  }
  /// The range is at most as long as the file.
  [[nodiscard]] Result<std::vector<std::byte>> read(const ByteRange& range) const {
    std::vector<std::byte> bytes(range.length);
    const std::size_t known = read_at(descriptor_, range.offset, bytes);
    if (errno != 0) return Error{fmt::format("it cannot be read: {}", std::strerror(errno))};
    bytes.resize(known);
    return bytes;
  }

 private:
  const int descriptor_;
};

class PmtilesSource : public TileSource, public TileLister {
 public:
  PmtilesSource(std::string name, std::shared_ptr<OpenFile> file, PmtilesSet set)
      : name_(std::move(name)), file_(std::move(file)), set_(std::move(set)) {}

  [[nodiscard]] const TileSetInfo& info() const override { return set_.info; }

  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(set_.info.grid, id)) return TileFailure{MissingKind::absent, "outside the tile set"};
    for (int reads = 0; reads < kMaxPmtilesReads; ++reads) {
      const auto step = set_.index->next(id);
      if (!step) return step.error();
      auto bytes = file_->read(step->range);
      if (!bytes) return TileFailure{MissingKind::failed, bytes.error().message};
      if (bytes->size() < step->range.length) return TileFailure{MissingKind::broken, "the file ends too early"};
      if (!step->is_tile) {
        if (Status learned = set_.index->learn(step->range, *bytes); !learned) {
          return TileFailure{MissingKind::broken, learned.error().message};
        }
        continue;
      }
      auto tile = set_.index->unpack_tile(*std::move(bytes));
      if (!tile) return TileFailure{MissingKind::broken, tile.error().message};
      return EncodedTile{.bytes = *std::move(tile)};
    }
    return TileFailure{MissingKind::broken, "its directories are too large"};
  }

  /// Counts by the runs of all directories, which are read once.
  [[nodiscard]] std::optional<std::int64_t> count_tiles(int level) override {
    std::call_once(counted_, [this] {
      std::vector<std::int64_t> counts(kMaxTileLevel + 1);
      const Status walked = walk([&](const PmtilesEntry& entry) {
        for (int at = 0; at <= kMaxTileLevel; ++at) {
          const std::uint64_t first = std::max(entry.tile, first_number(at));
          const std::uint64_t last = std::min(entry.tile + entry.run, first_number(at + 1));
          if (first < last) counts[static_cast<std::size_t>(at)] += static_cast<std::int64_t>(last - first);
        }
        return true;
      });
      if (walked) counts_ = std::move(counts);
    });
    if (counts_.empty()) return std::nullopt;
    return counts_.at(static_cast<std::size_t>(level));
  }

  [[nodiscard]] Status for_each_tile(const std::function<bool(const TileId&)>& call) override {
    return walk([&](const PmtilesEntry& entry) {
      for (std::uint64_t i = 0; i < entry.run && entry.tile + i < first_number(kMaxTileLevel + 1); ++i) {
        const TileId id = tile_of_number(entry.tile + i);
        if (exists(set_.info.grid, id) && !call(id)) return false;
      }
      return true;
    });
  }

 private:
  using Call = std::function<bool(const PmtilesEntry&)>;

  /// State of a walk through all directories. Tile numbers only ascend, so directories that lead to each other end it.
  struct Walk {
    const Call& call;
    std::uint64_t next = 0;  ///< no later entry begins before this number
    bool stopped = false;
  };

  /// Calls `call` for each run of tiles, in ascending order, until it returns false.
  [[nodiscard]] Status walk(const Call& call) const {
    Walk state{.call = call};
    if (Status walked = walk(set_.index->root(), 1, state); !walked) {
      return Error{fmt::format("{}: its tiles cannot be listed: {}", name_, walked.error().message)};
    }
    return Done{};
  }

  [[nodiscard]] Status walk(const PmtilesDirectory& directory, int depth, Walk& state) const {
    for (const PmtilesEntry& entry : directory) {
      if (entry.tile < state.next) return Error{"its directories list tiles out of order, or lead to each other"};
      if (entry.run > 0) {
        state.next = entry.tile + entry.run;
        state.stopped = !state.call(entry);
      } else if (depth == kMaxPmtilesDepth) {
        return Error{"its leaf directories lead to each other, or are nested too deep"};
      } else if (Status walked = walk_leaf(entry, depth, state); !walked) {
        return walked;
      }
      if (state.stopped) return Done{};
    }
    return Done{};
  }

  [[nodiscard]] Status walk_leaf(const PmtilesEntry& entry, int depth, Walk& state) const {
    const auto range = set_.index->leaf_range(entry);
    if (!range) return range.error();
    const auto bytes = file_->read(*range);
    if (!bytes) return bytes.error();
    const auto directory = set_.index->read_directory(*bytes);
    return directory ? walk(*directory, depth + 1, state) : Status(directory.error());
  }

  const std::string name_;
  const std::shared_ptr<OpenFile> file_;
  const PmtilesSet set_;
  std::once_flag counted_;
  std::vector<std::int64_t> counts_;
};

}  // namespace

Result<std::string> read_pmtiles_metadata(const std::filesystem::path& path) {
  const OpenFile file(path);
  if (!file.is_open()) return Error{std::strerror(errno)};
  const auto head = file.read({.offset = 0, .length = kPmtilesHeaderBytes});
  if (!head) return head.error();
  const auto header = parse_pmtiles_header(*head, file.size());
  if (!header) return header.error();
  return read_pmtiles_metadata([&](const ByteRange& range) { return file.read(range); }, *header);
}

Result<std::unique_ptr<TileSource>> open_pmtiles(const std::filesystem::path& path) {
  const std::string name = path.string();
  auto file = std::make_shared<OpenFile>(path);
  if (!file->is_open()) return Error{fmt::format("{}: cannot be opened: {}", name, std::strerror(errno))};
  auto set =
      describe_pmtiles([&](const ByteRange& range) { return file->read(range); }, [&] { return file->size(); }, name);
  if (!set) return set.error();
  return std::unique_ptr<TileSource>(std::make_unique<PmtilesSource>(name, std::move(file), *std::move(set)));
}

}  // namespace terrella
