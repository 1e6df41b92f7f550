#include "streaming/pmtiles/pmtiles_index.h"

#include <algorithm>
#include <optional>

#include "streaming/pmtiles/tile_number.h"
#include "streaming/sets/directory_source.h"

namespace terrella {
namespace {

constexpr std::size_t kMaxKeptBytes = 64UL << 20;

TileFailure broken_archive(const char* why) { return {MissingKind::broken, why}; }

std::size_t leaf_bytes(const PmtilesDirectory& leaf) { return leaf.size() * sizeof(PmtilesEntry); }

/// Place in the file of bytes in a section; none if they reach beyond it.
std::optional<ByteRange> in_section(const PmtilesEntry& entry, const ByteRange& section) {
  if (!is_within({entry.offset, entry.length}, section.length)) return std::nullopt;
  return ByteRange{.offset = section.offset + entry.offset, .length = entry.length};
}

}  // namespace

PmtilesIndex::PmtilesIndex(const PmtilesHeader& header, PmtilesDirectory root)
    : header_(header), root_(std::make_shared<const PmtilesDirectory>(std::move(root))) {}

Result<PmtilesIndex::Step, TileFailure> PmtilesIndex::next(const TileId& id) { return next(tile_number(id)); }

Result<PmtilesIndex::Step, TileFailure> PmtilesIndex::next(std::uint64_t tile) {
  std::shared_ptr<const PmtilesDirectory> directory = root_;
  for (int depth = 1;; ++depth) {
    const PmtilesEntry* entry = find_entry(*directory, tile);
    if (entry == nullptr) return TileFailure{MissingKind::absent, "the archive has no such tile"};
    if (entry->run > 0) return tile_step(*entry);
    const Result<ByteRange> range = leaf_range(*entry);
    if (!range) return broken_archive(range.error().message.c_str());
    if (depth == kMaxPmtilesDepth)
      return broken_archive("its leaf directories lead to each other, or are nested too deep");
    const std::lock_guard lock(mutex_);
    const auto kept = leaves_.find(*range);
    if (kept == leaves_.end()) return Step{.is_tile = false, .range = *range};
    kept->second.last_use = ++uses_;
    directory = kept->second.leaf;
  }
}

Result<PmtilesIndex::Step, TileFailure> PmtilesIndex::tile_step(const PmtilesEntry& entry) const {
  const auto range = in_section(entry, header_.tiles);
  if (!range) return broken_archive("its directory places the tile beyond the end of the tiles");
  if (range->length > kMaxTileBytes) return broken_archive("its directory gives the tile too many bytes");
  return Step{.is_tile = true, .range = *range};
}

Result<ByteRange> PmtilesIndex::leaf_range(const PmtilesEntry& entry) const {
  const auto range = in_section(entry, header_.leaves);
  if (!range || range->length > kMaxPackedBytes) {
    return Error{"its directory places a leaf directory beyond the end of the leaf directories"};
  }
  return *range;
}

Result<PmtilesDirectory> PmtilesIndex::read_directory(std::span<const std::byte> bytes) const {
  const auto unpacked = unpack(bytes, header_.directory_compression);
  if (!unpacked) return Error{"a directory is damaged: " + unpacked.error().message};
  return parse_pmtiles_directory(*unpacked);
}

Status PmtilesIndex::learn(const ByteRange& directory, std::span<const std::byte> bytes) {
  auto parsed = read_directory(bytes);
  if (!parsed) return parsed.error();
  const auto leaf = std::make_shared<const PmtilesDirectory>(*std::move(parsed));
  const std::lock_guard lock(mutex_);
  const std::size_t bytes_kept = leaf_bytes(*leaf);
  if (leaves_.try_emplace(directory, KeptLeaf{leaf, ++uses_}).second) kept_bytes_ += bytes_kept;
  make_room();
  return Done{};
}

void PmtilesIndex::make_room() {
  while (kept_bytes_ > kMaxKeptBytes && leaves_.size() > 1) {
    const auto oldest = std::ranges::min_element(leaves_, {}, [](const auto& entry) { return entry.second.last_use; });
    kept_bytes_ -= leaf_bytes(*oldest->second.leaf);
    leaves_.erase(oldest);
  }
}

Result<std::vector<std::byte>> PmtilesIndex::unpack_tile(std::vector<std::byte> bytes) const {
  if (header_.tile_compression == PmtilesCompression::none) return bytes;
  return unpack(bytes, header_.tile_compression, kMaxTileBytes);
}

}  // namespace terrella
