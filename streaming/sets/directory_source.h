#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "tiles/tile_source.h"

namespace terrella {

/// Locations of tiles in a directory: `folder of the level`/x/y.extension.
struct DirectoryLayout {
  std::filesystem::path root;
  std::map<int, std::string> folder;  ///< for each level
  std::string extension;
  bool rows_from_south = false;
};

/// A larger tile file counts as broken.
inline constexpr std::size_t kMaxTileBytes = 32UL << 20;

[[nodiscard]] std::unique_ptr<TileSource> make_directory_source(TileSetInfo info, DirectoryLayout layout);

/// Opens a directory with tileset.json or tilemapresource.xml beside its tiles.
[[nodiscard]] Result<std::unique_ptr<TileSource>> open_directory(const std::filesystem::path& path);

}  // namespace terrella
