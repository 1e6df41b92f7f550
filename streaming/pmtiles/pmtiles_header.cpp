#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "streaming/pmtiles/pmtiles_format.h"
#include "streaming/sets/tileset_json.h"
#include "tiles/tile_grid.h"

namespace terrella {
namespace {

constexpr int kPmtilesVersion = 3;
constexpr std::string_view kMagic = "PMTiles";

/// Fields of the header, by their first byte. Numbers have their lowest byte first.
enum HeaderField : std::size_t {
  kVersionAt = 7,
  kRootAt = 8,  // sections: offset and length, 8 bytes each
  kMetadataAt = 24,
  kLeavesAt = 40,
  kTilesAt = 56,
  kAddressedTilesAt = 72,  // 8 bytes
  kTileEntriesAt = 80,
  kTileContentsAt = 88,
  kClusteredAt = 96,  // 1 byte
  kDirectoryCompressionAt = 97,
  kTileCompressionAt = 98,
  kTileTypeAt = 99,
  kMinLevelAt = 100,
  kMaxLevelAt = 101,
  kWestAt = 102,  // 4 bytes with a sign, 1e-7 degrees
  kSouthAt = 106,
  kEastAt = 110,
  kNorthAt = 114,
  kCentreLevelAt = 118,  // 1 byte
  kCentreLonAt = 119,    // 4 bytes
  kCentreLatAt = 123,
};

std::uint64_t number_at(std::span<const std::byte> head, std::size_t at, std::size_t bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = bytes; i-- > 0;) number = number << 8 | std::to_integer<std::uint64_t>(head[at + i]);
  return number;
}

ByteRange range_at(std::span<const std::byte> head, std::size_t at) {
  return {.offset = number_at(head, at, 8), .length = number_at(head, at + 8, 8)};
}

double degrees_at(std::span<const std::byte> head, std::size_t at) {
  return static_cast<std::int32_t>(number_at(head, at, 4)) * 1e-7;
}

Result<PmtilesCompression> compression_at(std::span<const std::byte> head, std::size_t at, const char* what) {
  constexpr std::array kNames = {"an unknown method", "nothing", "gzip", "brotli", "zstd"};
  const std::uint64_t value = number_at(head, at, 1);
  if (value == 1 || value == 2) return static_cast<PmtilesCompression>(value);
  return Error{fmt::format("its {} are compressed with {}; nothing and gzip can be read. Convert it: pmtiles convert",
                           what, value < kNames.size() ? kNames.at(value) : kNames.front())};
}

/// Type 0 is "unknown or other": the bytes of the tiles then tell their format.
Status check_tile_type(std::uint64_t type) {
  if (type == 0 || (type >= 2 && type <= 4)) return Done{};
  const char* name = type == 1 ? "vector tiles (MVT)" : type == 5 ? "AVIF pictures" : "of a type that is not known";
  return Error{fmt::format("its tiles are {}; JPEG, PNG and WebP pictures can be drawn", name)};
}

Status check_section(const char* name, const ByteRange& range, std::optional<std::uint64_t> file_bytes) {
  constexpr std::uint64_t kMaxOffset = std::uint64_t{1} << 62;
  if (!is_within(range, file_bytes.value_or(kMaxOffset))) {
    return Error{
        fmt::format("its {} should be {} bytes from byte {} on, beyond the file's end; it is truncated or "
                    "damaged, get it again",
                    name, range.length, range.offset)};
  }
  return Done{};
}

Status check_sections(const PmtilesHeader& header, std::optional<std::uint64_t> file_bytes) {
  for (const auto& [name, range] : {std::pair("root directory", header.root), std::pair("metadata", header.metadata),
                                    std::pair("leaf directories", header.leaves), std::pair("tiles", header.tiles)}) {
    if (Status within = check_section(name, range, file_bytes); !within) return within;
  }
  if (header.root.length == 0) return Error{"its root directory is empty"};
  if (header.root.length > kMaxPackedBytes || header.metadata.length > kMaxPackedBytes) {
    return Error{fmt::format("its root directory or metadata have over {} bytes", kMaxPackedBytes)};
  }
  return Done{};
}

GeoRect bounds_at(std::span<const std::byte> head) {
  const double west = degrees_at(head, kWestAt), south = degrees_at(head, kSouthAt);
  const double east = degrees_at(head, kEastAt), north = degrees_at(head, kNorthAt);
  if (!(west < east && south < north)) return {};
  return {.west = Angle::degrees(std::clamp(west, -180.0, 180.0)),
          .south = Angle::degrees(std::clamp(south, -90.0, 90.0)),
          .east = Angle::degrees(std::clamp(east, -180.0, 180.0)),
          .north = Angle::degrees(std::clamp(north, -90.0, 90.0))};
}

bool begins_with_text(std::span<const std::byte> head, std::string_view magic) {
  return head.size() >= magic.size() && std::memcmp(head.data(), magic.data(), magic.size()) == 0;
}

}  // namespace

bool begins_as_pmtiles(std::span<const std::byte> head) {
  const bool old = head.size() >= 4 && begins_with_text(head, "PM") && head[3] == std::byte{0} &&
                   (head[2] == std::byte{1} || head[2] == std::byte{2});
  return old || begins_with_text(head, kMagic);
}

Result<PmtilesHeader> parse_pmtiles_header(std::span<const std::byte> head, std::optional<std::uint64_t> file_bytes) {
  if (!begins_as_pmtiles(head)) return Error{"it does not begin as a PMTiles archive"};
  const auto version = std::to_integer<int>(
      head[begins_with_text(head, kMagic) ? std::min<std::size_t>(kVersionAt, head.size() - 1) : 2]);
  if (head.size() > kMagic.size() && version != kPmtilesVersion) {
    return Error{fmt::format("it is PMTiles version {}, version {} can be read; convert it: pmtiles convert", version,
                             kPmtilesVersion)};
  }
  if (head.size() < kPmtilesHeaderBytes) return Error{"it ends within its header; it is truncated, get it again"};
  const std::uint64_t type = number_at(head, kTileTypeAt, 1);
  if (Status known = check_tile_type(type); !known) return known.error();
  const auto directories = compression_at(head, kDirectoryCompressionAt, "directories");
  if (!directories) return directories.error();
  const auto tiles = compression_at(head, kTileCompressionAt, "tiles");
  if (!tiles) return tiles.error();
  PmtilesHeader header{.root = range_at(head, kRootAt),
                       .metadata = range_at(head, kMetadataAt),
                       .leaves = range_at(head, kLeavesAt),
                       .tiles = range_at(head, kTilesAt),
                       .directory_compression = *directories,
                       .tile_compression = *tiles,
                       .min_level = static_cast<int>(number_at(head, kMinLevelAt, 1)),
                       .max_level = static_cast<int>(number_at(head, kMaxLevelAt, 1)),
                       .bounds = bounds_at(head),
                       .tile_type = static_cast<PmtilesTileType>(type),
                       .clustered = number_at(head, kClusteredAt, 1) == 1,
                       .addressed_tiles = number_at(head, kAddressedTilesAt, 8),
                       .tile_entries = number_at(head, kTileEntriesAt, 8),
                       .tile_contents = number_at(head, kTileContentsAt, 8)};
  if (header.min_level > header.max_level || header.max_level > kMaxTileLevel) {
    return Error{
        fmt::format("its levels are {} to {}, [0, {}] can be read", header.min_level, header.max_level, kMaxTileLevel)};
  }
  if (Status sections = check_sections(header, file_bytes); !sections) return sections.error();
  return header;
}

std::array<std::byte, kPmtilesHeaderBytes> pmtiles_header_bytes(const PmtilesHeader& header) {
  std::array<std::byte, kPmtilesHeaderBytes> head{};
  const auto put = [&head](std::size_t at, std::size_t bytes, std::uint64_t number) {
    for (std::size_t i = 0; i < bytes; ++i) head.at(at + i) = static_cast<std::byte>(number >> (8 * i));
  };
  const auto put_range = [&put](std::size_t at, const ByteRange& range) {
    put(at, 8, range.offset);
    put(at + 8, 8, range.length);
  };
  const auto put_degrees = [&put](std::size_t at, double steps) {
    put(at, 4, static_cast<std::uint32_t>(static_cast<std::int32_t>(steps)));
  };
  std::memcpy(head.data(), kMagic.data(), kMagic.size());
  put(kVersionAt, 1, kPmtilesVersion);
  put_range(kRootAt, header.root);
  put_range(kMetadataAt, header.metadata);
  put_range(kLeavesAt, header.leaves);
  put_range(kTilesAt, header.tiles);
  put(kAddressedTilesAt, 8, header.addressed_tiles);
  put(kTileEntriesAt, 8, header.tile_entries);
  put(kTileContentsAt, 8, header.tile_contents);
  put(kClusteredAt, 1, header.clustered ? 1 : 0);
  put(kDirectoryCompressionAt, 1, static_cast<std::uint64_t>(header.directory_compression));
  put(kTileCompressionAt, 1, static_cast<std::uint64_t>(header.tile_compression));
  put(kTileTypeAt, 1, static_cast<std::uint64_t>(header.tile_type));
  put(kMinLevelAt, 1, static_cast<std::uint64_t>(header.min_level));
  put(kMaxLevelAt, 1, static_cast<std::uint64_t>(header.max_level));
  constexpr double kRounding = 1e-5;  // more than the error of a double, less than a pixel of any level
  const auto steps_of = [](Angle angle) { return tidy_degrees(angle) * 1e7; };
  const bool crosses = header.bounds.east.rad() <= header.bounds.west.rad();
  const double west = std::floor(crosses ? -180e7 : steps_of(header.bounds.west) + kRounding);
  const double east = std::ceil(crosses ? 180e7 : steps_of(header.bounds.east) - kRounding);
  const double south = std::floor(steps_of(header.bounds.south) + kRounding);
  const double north = std::ceil(steps_of(header.bounds.north) - kRounding);
  put_degrees(kWestAt, west);
  put_degrees(kSouthAt, south);
  put_degrees(kEastAt, east);
  put_degrees(kNorthAt, north);
  put(kCentreLevelAt, 1, static_cast<std::uint64_t>(header.min_level));
  put_degrees(kCentreLonAt, std::round((west + east) / 2.0));
  put_degrees(kCentreLatAt, std::round((south + north) / 2.0));
  return head;
}

}  // namespace terrella
