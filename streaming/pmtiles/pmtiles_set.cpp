#include "streaming/pmtiles/pmtiles_set.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "codecs/image.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"
#include "streaming/sets/tileset_json.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

Result<std::vector<std::byte>> read_whole(const ReadBytes& read, const ByteRange& range) {
  auto bytes = read(range);
  if (bytes && bytes->size() < range.length) return Error{"it ends too early; it is truncated, get it again"};
  return bytes;
}

/// Text of a field; empty if it is missing or no text. Metadata are for people, and any program may have written them.
std::string metadata_text(const nlohmann::json& object, const char* field) {
  const auto found = object.find(field);
  if (found == object.end() || !found->is_string()) return {};
  const std::string text = *found;
  return text.size() <= kMaxJsonTextBytes ? text : std::string();
}

Status read_archive_metadata(const ReadBytes& read, const PmtilesHeader& header, TileSetInfo& info) {
  const auto text = read_pmtiles_metadata(read, header);
  if (!text) return text.error();
  if (text->empty()) return Done{};
  const auto object = parse_json_object(*text, kMaxUnpackedBytes, "its metadata");
  if (!object) return object.error();
  info.name = metadata_text(*object, "name");
  info.attribution = metadata_text(*object, "attribution");
  info.body = stated_body(metadata_text(*object, "body"));
  return Done{};
}

Result<PmtilesHeader> read_archive_header(const ReadBytes& read,
                                          const std::function<std::optional<std::uint64_t>()>& file_bytes) {
  const auto head = read({.offset = 0, .length = kPmtilesHeaderBytes});
  if (!head) return head.error();
  return parse_pmtiles_header(*head, file_bytes());
}

/// Reads the first tile through the directories that lead to it.
Result<std::vector<std::byte>> read_first_tile(const ReadBytes& read, PmtilesIndex& index) {
  for (int reads = 0; reads < kMaxPmtilesDepth; ++reads) {
    const auto step = index.next(index.first_tile());
    if (!step) return Error{step.error().why};
    const auto bytes = read_whole(read, step->range);
    if (!bytes) return bytes.error();
    if (step->is_tile) return index.unpack_tile(*bytes);
    if (Status learned = index.learn(step->range, *bytes); !learned) return learned.error();
  }
  return Error{"its leaf directories are nested too deep"};
}

Status look_at_first_tile(const std::vector<std::byte>& tile, TileSetInfo& info) {
  info.format = sniff_format(tile);
  const auto size = picture_size(tile);
  if (!size) return Error{"its first tile: " + size.error().message};
  if (size->width_px != size->height_px) return Error{"its tiles are not square"};
  info.grid.tile_px = size->width_px;
  return Done{};
}

Result<PmtilesSet> describe_archive(const ReadBytes& read,
                                    const std::function<std::optional<std::uint64_t>()>& file_bytes) {
  const auto header = read_archive_header(read, file_bytes);
  if (!header) return header.error();
  const auto packed = read_whole(read, header->root);
  if (!packed) return packed.error();
  const auto unpacked = unpack(*packed, header->directory_compression);
  if (!unpacked) return Error{"its root directory: " + unpacked.error().message};
  auto root = parse_pmtiles_directory(*unpacked);
  if (!root) return root.error();
  PmtilesSet set{.info = {}, .index = std::make_shared<PmtilesIndex>(*header, *std::move(root))};
  if (Status read_it = read_archive_metadata(read, *header, set.info); !read_it) return read_it.error();
  const auto tile = read_first_tile(read, *set.index);
  if (!tile) return tile.error();
  if (Status looked = look_at_first_tile(*tile, set.info); !looked) return looked.error();
  TileGrid& grid = set.info.grid;
  grid.projection = Projection::web_mercator;
  grid.root_span_deg = 360.0;
  grid.min_level = header->min_level;
  grid.max_level = header->max_level;
  grid.bounds = header->bounds;
  return set;
}

}  // namespace

Result<std::string> read_pmtiles_metadata(const ReadBytes& read, const PmtilesHeader& header) {
  if (header.metadata.length == 0) return std::string();
  const auto packed = read_whole(read, header.metadata);
  if (!packed) return packed.error();
  const auto bytes = unpack(*packed, header.directory_compression);
  if (!bytes) return Error{"its metadata: " + bytes.error().message};
  return std::string(as_text(*bytes));
}

Result<PmtilesSet> describe_pmtiles(const ReadBytes& read,
                                    const std::function<std::optional<std::uint64_t>()>& file_bytes,
                                    const std::string& where) {
  auto set = describe_archive(read, file_bytes);
  if (!set) return Error{fmt::format("{}: {}", where, set.error().message)};
  if (Status checked = check_grid(set->info.grid, where); !checked) return checked.error();
  return set;
}

}  // namespace terrella
