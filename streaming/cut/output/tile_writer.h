#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "base/result.h"
#include "streaming/cut/output/part_name.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Writes a tile set under a temporary name, and renames it in finish(). Without finish() nothing is left under the
/// final name. Errors name the output. thread: one at a time
class TileWriter {
 public:
  virtual ~TileWriter() = default;
  [[nodiscard]] virtual Status put(const TileId& id, std::span<const std::byte> bytes) = 0;
  /// Writes everything to the disk, then gives the output its name with take_name().
  [[nodiscard]] virtual Status finish() = 0;
};

/// Arguments of a tile writer.
struct WriterSetup {
  std::filesystem::path output;
  /// Prefix of temporary names, on the output's file system; existing files of these names are removed.
  std::filesystem::path part;
  TileSetInfo info;
  std::string last_change;  ///< "2026-01-31T12:00:00.000Z"
  std::string mark;         ///< cut_mark()
  MayReplace may_replace;
};

/// True if an output of this name is a GeoPackage, false if it is a folder.
[[nodiscard]] bool is_gpkg_name(const std::filesystem::path& output);

/// Makes a GeoPackage writer for a name that ends in .gpkg, else a writer of a directory {z}/{x}/{y}.jpg|png with
/// tileset.json. The same tiles in the same order give the same bytes.
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_tile_writer(const WriterSetup& setup);

[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_gpkg_writer(const WriterSetup& setup);
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_folder_writer(const WriterSetup& setup);

/// "OUTPUT: cannot be written: No space left on device; …" thread: any
[[nodiscard]] Error cannot_write(const std::filesystem::path& output, int error_number);

}  // namespace terrella
