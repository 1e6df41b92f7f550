#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/open_scene/open_picture.h"
#include "apps/open_scene/options/scene_options.h"
#include "base/result.h"
#include "tiles/elevation_source.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens TILESET, with pictures or heights. An empty TILESET opens the included Earth. open_picture() opens a picture,
/// with `progress`. --projection and --latitude
/// override the tile set's description. The error names the input. Throws BrokenInstallation. thread: any, one at a
/// time
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_any_tiles(const SourceOptions& options,
                                                                 const CutProgress& progress = {});

/// Like open_any_tiles(), but refuses tiles of numbers and says how to use them. thread: main
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_imagery(const SourceOptions& options);

/// Opens the heights of --elevation; nullopt if the option is empty. The error names the input. Throws
/// BrokenInstallation. thread: main
[[nodiscard]] Result<std::optional<ElevationSource>> open_elevation(const SceneOptions& options);

/// Checks quickly that TILESET exists, before slow work starts. Throws BrokenInstallation. thread: any
[[nodiscard]] Status find_imagery(const SourceOptions& options);

/// True for a file with the first bytes or the name of a JPEG, PNG, WebP or TIFF. thread: any
[[nodiscard]] bool is_picture(const std::filesystem::path& path);

/// Folder for tile sets cut from pictures, from the value of --cache (not "off"). An empty value gives
/// $XDG_CACHE_HOME/terrella or ~/.cache/terrella. A GeoPackage's name gives NAME-pictures beside the file. Any other
/// value is the folder itself. thread: any
[[nodiscard]] Result<std::filesystem::path> picture_cache_folder(const std::string& cache);

}  // namespace terrella
