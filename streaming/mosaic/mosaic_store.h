#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "streaming/cache/sqlite_writer.h"
#include "streaming/mosaic/mosaic_sheet.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A file's facts as text for the store, and back; nothing for a text of another version or a damaged one. The path
/// and the mark are not among them. thread: any
[[nodiscard]] std::string header_text(const PlacedFile& file);
[[nodiscard]] std::optional<PlacedFile> parse_header_text(const std::string& text);

/// The part of a mosaic that the cache folder keeps: facts from the headers of its files, and the overview of the
/// whole. Several processes may use one file. Entries that cannot be read or written count as missing, because all of
/// them can be made again. thread: any, several at once
class MosaicStore {
 public:
  /// The error says why the file can neither be opened nor made.
  [[nodiscard]] static Result<std::unique_ptr<MosaicStore>> open(const std::filesystem::path& path);

  /// The facts of all files by their path: the file's mark, and the text.
  using Headers = std::unordered_map<std::string, std::pair<std::uint64_t, std::string>>;
  [[nodiscard]] Headers headers();
  struct Header {
    std::string path;
    std::uint64_t mark = 0;
    std::string text;
  };
  void keep_headers(const std::vector<Header>& headers);

  /// The bytes of a tile that was kept with this mark.
  [[nodiscard]] std::optional<std::vector<std::byte>> tile(const TileId& id, std::uint64_t mark);
  void keep_tile(const TileId& id, std::uint64_t mark, const std::vector<std::byte>& bytes);

 private:
  explicit MosaicStore(SqliteWriter database) : database_(std::move(database)) {}

  std::mutex mutex_;  ///< guards the connection
  SqliteWriter database_;
};

}  // namespace terrella
