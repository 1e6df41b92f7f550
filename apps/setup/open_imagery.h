#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "apps/setup/scene_options.h"
#include "base/result.h"
#include "tiles/elevation_source.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Told how many of a picture's rows are cut; false asks to stop.
using CutProgress = std::function<bool(std::int64_t done, std::int64_t total)>;

/// Opens what TILESET names, pictures or heights: nothing is the Earth that the program carries; a picture is cut into
/// the cache, with a progress bar on standard error, unless it was before; anything else is opened as a tile set.
/// --projection and
/// --latitude, if given, overrule what the tile set says of itself. The error names the input. Throws
/// BrokenInstallation. `progress` is told instead of the bar. thread: any, one at a time
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_any_tiles(const SceneOptions& options,
                                                                 const CutProgress& progress = {});

/// The same for pictures to draw: tiles of heights are refused, with what they are for. thread: main
[[nodiscard]] Result<std::shared_ptr<TileSource>> open_imagery(const SceneOptions& options);

/// What --elevation names; nothing if it names nothing. The error names the input. Throws BrokenInstallation.
/// thread: main
[[nodiscard]] Result<std::optional<ElevationSource>> open_elevation(const SceneOptions& options);

/// Fails if what TILESET names is not there at all: a quick look before anything slow. Throws BrokenInstallation.
/// thread: any
[[nodiscard]] Status find_imagery(const SceneOptions& options);

/// True for a file that begins as a JPEG, PNG or TIFF does, or whose name ends as theirs do. thread: any
[[nodiscard]] bool is_picture(const std::filesystem::path& path);

/// True for a file that begins as a JPEG, PNG or TIFF does. thread: any
[[nodiscard]] bool begins_as_picture(const std::filesystem::path& path);

/// The folder that pictures are cut into, for --cache as given (not "off"). Empty: $XDG_CACHE_HOME/terrella or
/// ~/.cache/terrella. A GeoPackage's name stands for the folder NAME-pictures beside it, anything else is the folder
/// itself. thread: any
[[nodiscard]] Result<std::filesystem::path> picture_cache_folder(const std::string& cache);

}  // namespace terrella
