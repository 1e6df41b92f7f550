#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "geo/result.h"
#include "streaming/tile_source.h"

namespace terrella {

/// Writes a tile set under a temporary name beside its own, which it takes with finish(). Destroyed before that, it
/// leaves nothing behind. Errors name the output. thread: one at a time
class TileWriter {
 public:
  virtual ~TileWriter() = default;
  [[nodiscard]] virtual Status put(const TileId& id, std::span<const std::byte> bytes) = 0;
  /// Everything is on the disk, then the output appears under its name; what had that name is replaced.
  [[nodiscard]] virtual Status finish() = 0;
};

/// A GeoPackage if the name ends in .gpkg, else a directory {z}/{x}/{y}.jpg|png with tileset.json. Refuses to replace
/// what is neither a file that was a GeoPackage by name nor a directory that is empty or a tile set.
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_tile_writer(const std::filesystem::path& output,
                                                                   const TileSetInfo& info);

[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_gpkg_writer(const std::filesystem::path& output,
                                                                   const TileSetInfo& info);
[[nodiscard]] Result<std::unique_ptr<TileWriter>> make_folder_writer(const std::filesystem::path& output,
                                                                     const TileSetInfo& info);

/// "OUTPUT: cannot be written: No space left on device; …" thread: any
[[nodiscard]] Error cannot_write(const std::filesystem::path& output, int error_number);

}  // namespace terrella
