#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "streaming/pmtiles/pmtiles_format.h"
#include "tiles/tile_grid.h"

namespace terrella {
namespace {

constexpr int kPmtilesVersion = 3;
constexpr std::string_view kMagic = "PMTiles";

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
  const double west = degrees_at(head, 102), south = degrees_at(head, 106);
  const double east = degrees_at(head, 110), north = degrees_at(head, 114);
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
  const auto version =
      std::to_integer<int>(head[begins_with_text(head, kMagic) ? std::min<std::size_t>(7, head.size() - 1) : 2]);
  if (head.size() > kMagic.size() && version != kPmtilesVersion) {
    return Error{fmt::format("it is PMTiles version {}, version {} can be read; convert it: pmtiles convert", version,
                             kPmtilesVersion)};
  }
  if (head.size() < kPmtilesHeaderBytes) return Error{"it ends within its header; it is truncated, get it again"};
  if (Status type = check_tile_type(number_at(head, 99, 1)); !type) return type.error();
  const auto directories = compression_at(head, 97, "directories");
  if (!directories) return directories.error();
  const auto tiles = compression_at(head, 98, "tiles");
  if (!tiles) return tiles.error();
  PmtilesHeader header{.root = range_at(head, 8),
                       .metadata = range_at(head, 24),
                       .leaves = range_at(head, 40),
                       .tiles = range_at(head, 56),
                       .directory_compression = *directories,
                       .tile_compression = *tiles,
                       .min_level = static_cast<int>(number_at(head, 100, 1)),
                       .max_level = static_cast<int>(number_at(head, 101, 1)),
                       .bounds = bounds_at(head)};
  if (header.min_level > header.max_level || header.max_level > kMaxTileLevel) {
    return Error{
        fmt::format("its levels are {} to {}, [0, {}] can be read", header.min_level, header.max_level, kMaxTileLevel)};
  }
  if (Status sections = check_sections(header, file_bytes); !sections) return sections.error();
  return header;
}

}  // namespace terrella
