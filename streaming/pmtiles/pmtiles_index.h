#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/result.h"
#include "streaming/pmtiles/pmtiles_format.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Most directories that are read on the way to a tile. The specification's own readers stop there too.
inline constexpr int kMaxPmtilesDepth = 4;
/// Most reads for one tile. More mean that huge directories evict each other.
inline constexpr int kMaxPmtilesReads = 16;

/// Finds tiles in a PMTiles archive. It does not read the file: the caller reads the bytes that next() names. Leaf
/// directories are kept, up to 64 MiB. thread: any
class PmtilesIndex {
 public:
  PmtilesIndex(const PmtilesHeader& header, PmtilesDirectory root);

  /// The next bytes to read on the way to a tile: its own, or a leaf directory's for learn().
  struct Step {
    bool is_tile = false;
    ByteRange range;  ///< within the header's sections
  };
  /// Fails if the archive has no such tile (absent) or is damaged on the way to the tile (broken).
  [[nodiscard]] Result<Step, TileFailure> next(const TileId& id);
  [[nodiscard]] Result<Step, TileFailure> next(std::uint64_t tile);
  /// Takes the bytes of a leaf directory that next() named. Keeps nothing of damaged bytes and says what is wrong.
  [[nodiscard]] Status learn(const ByteRange& directory, std::span<const std::byte> bytes);
  /// Number of the first tile in the archive.
  [[nodiscard]] std::uint64_t first_tile() const { return root_->front().tile; }
  [[nodiscard]] const PmtilesDirectory& root() const { return *root_; }
  [[nodiscard]] const PmtilesHeader& header() const { return header_; }
  /// Place of a leaf directory in the file; fails if the entry points beyond the section.
  [[nodiscard]] Result<ByteRange> leaf_range(const PmtilesEntry& entry) const;
  /// Decompresses a directory or a tile.
  [[nodiscard]] Result<PmtilesDirectory> read_directory(std::span<const std::byte> bytes) const;
  [[nodiscard]] Result<std::vector<std::byte>> unpack_tile(std::vector<std::byte> bytes) const;

 private:
  using Leaf = std::shared_ptr<const PmtilesDirectory>;
  struct KeptLeaf {
    Leaf leaf;
    std::uint64_t last_use = 0;
  };
  [[nodiscard]] Result<Step, TileFailure> tile_step(const PmtilesEntry& entry) const;
  void make_room();

  const PmtilesHeader header_;
  const std::shared_ptr<const PmtilesDirectory> root_;
  std::mutex mutex_;  ///< guards the members below
  std::map<ByteRange, KeptLeaf> leaves_;
  std::size_t kept_bytes_ = 0;
  std::uint64_t uses_ = 0;
};

}  // namespace terrella
