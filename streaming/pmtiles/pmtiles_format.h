#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "geo/coordinates.h"
#include "streaming/byte_range.h"

/// Parts of a PMTiles archive, version 3 (github.com/protomaps/PMTiles, spec/v3). Every function that reads takes
/// hostile bytes; the errors do not name the file.
// thread: any, for all of this header
namespace terrella {

inline constexpr std::size_t kPmtilesHeaderBytes = 127;
/// Header and root directory lie within these bytes.
inline constexpr std::uint64_t kPmtilesHeadBytes = 16384;
/// A larger directory or larger metadata count as broken: bytes in the file, and after decompression.
inline constexpr std::uint64_t kMaxPackedBytes = 4U << 20;
inline constexpr std::size_t kMaxUnpackedBytes = 8U << 20;

/// Names of the specification.
enum class PmtilesCompression : std::uint8_t { unknown, none, gzip, brotli, zstd };
enum class PmtilesTileType : std::uint8_t { unknown, mvt, png, jpeg, webp, avif };

struct PmtilesHeader {
  ByteRange root;
  ByteRange metadata;
  ByteRange leaves;  ///< leaf directories; their offsets count from here
  ByteRange tiles;   ///< tile data; offsets of tiles count from here
  PmtilesCompression directory_compression = PmtilesCompression::none;
  PmtilesCompression tile_compression = PmtilesCompression::none;
  int min_level = 0;
  int max_level = 0;  ///< ≥ min_level, ≤ kMaxTileLevel
  GeoRect bounds;     ///< the whole planet if the header states no area
  PmtilesTileType tile_type = PmtilesTileType::unknown;
  bool clustered = false;             ///< tile data are in the order of tile numbers
  std::uint64_t addressed_tiles = 0;  ///< tiles before runs are merged; 0: unknown, for this and the next two
  std::uint64_t tile_entries = 0;     ///< entries of tiles in all directories
  std::uint64_t tile_contents = 0;    ///< different tiles
};

/// True for the first bytes of an archive of any version.
[[nodiscard]] bool begins_as_pmtiles(std::span<const std::byte> head);

/// Reads the header. Refuses other versions, vector tiles, AVIF, compressions other than gzip, and sections beyond the
/// end of a file of `file_bytes`, if known.
[[nodiscard]] Result<PmtilesHeader> parse_pmtiles_header(std::span<const std::byte> head,
                                                         std::optional<std::uint64_t> file_bytes);

/// Writes the header. Bounds are rounded outwards to 1e-7 degrees; bounds across ±180° become all longitudes. The
/// centre is the middle of the bounds at the coarsest level.
[[nodiscard]] std::array<std::byte, kPmtilesHeaderBytes> pmtiles_header_bytes(const PmtilesHeader& header);

/// An entry of a directory: `run` tiles from number `tile` on that share the same bytes, or a leaf directory if `run`
/// is 0. The offset counts from the section of tiles or of leaves.
struct PmtilesEntry {
  std::uint64_t tile = 0;
  std::uint64_t offset = 0;
  std::uint32_t length = 0;  ///< ≥ 1
  std::uint32_t run = 0;
  bool operator==(const PmtilesEntry&) const = default;
};
/// In ascending order of tiles; runs do not overlap. Never empty.
using PmtilesDirectory = std::vector<PmtilesEntry>;

/// Decompresses, to at most kMaxUnpackedBytes.
[[nodiscard]] Result<std::vector<std::byte>> unpack(std::span<const std::byte> bytes, PmtilesCompression compression,
                                                    std::size_t max_bytes = kMaxUnpackedBytes);
/// Reads a directory after decompression. Refuses numbers that end early or overflow, empty tiles, entries out of
/// order, and runs that overlap.
[[nodiscard]] Result<PmtilesDirectory> parse_pmtiles_directory(std::span<const std::byte> bytes);
/// Writes a directory: not empty, in ascending order.
[[nodiscard]] std::vector<std::byte> pmtiles_directory_bytes(const PmtilesDirectory& directory);
/// Compresses with gzip. The same bytes give the same result. Fails if memory runs out.
[[nodiscard]] Result<std::vector<std::byte>> pack(std::span<const std::byte> bytes);
/// The entry that covers the tile: a run that contains it, or the leaf directory that may list it; null if none.
[[nodiscard]] const PmtilesEntry* find_entry(const PmtilesDirectory& directory, std::uint64_t tile);

}  // namespace terrella
