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
  std::string mark;         ///< cut_key of the set
  MayReplace may_replace;
};

enum class OutputKind { folder, geopackage, mbtiles, pmtiles };
/// Kind of an output, by the ending of its name: .gpkg, .mbtiles, .pmtiles, else a folder.
[[nodiscard]] OutputKind output_kind(const std::filesystem::path& output);
/// True for the formats that hold tiles in Web Mercator alone: MBTiles and PMTiles.
[[nodiscard]] bool is_web_format(const std::filesystem::path& output);
/// Fails if the output's format cannot hold the set. Folders and GeoPackages hold every set.
[[nodiscard]] Status check_output(const std::filesystem::path& output, const TileSetInfo& info);

/// Makes the writer for the output's kind; a folder has {z}/{x}/{y}.jpg|png and tileset.json. The set passes
/// check_output(). The same tiles in the same order give the same bytes.
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_tile_writer(const WriterSetup& setup);

[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_gpkg_writer(const WriterSetup& setup);
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_folder_writer(const WriterSetup& setup);
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_mbtiles_writer(const WriterSetup& setup);
/// Tiles may come in any order.
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_pmtiles_writer(const WriterSetup& setup);

/// "OUTPUT: cannot be written: No space left on device; …" thread: any
[[nodiscard]] Error cannot_write(const std::filesystem::path& output, int error_number);

}  // namespace terrella
