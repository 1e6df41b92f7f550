#pragma once

#include <filesystem>

namespace terrella {

/// Reader of a file.
enum class PictureKind {
  none,    ///< no picture
  plain,   ///< JPEG, PNG or WebP: read row by row by the library of its format
  raster,  ///< any other format that GDAL reads (RasterFile)
};

/// Tells what reads a file, by its first bytes; by its name if GDAL is not installed. Also takes GDAL's name of a
/// sub-dataset (NETCDF:"FILE":NAME). Loads GDAL for files that are neither plain pictures nor TIFFs nor tile sets.
/// Blocks. thread: any
[[nodiscard]] PictureKind picture_kind(const std::filesystem::path& path);

/// The file that holds a picture: the path itself, or the file in GDAL's name of a sub-dataset. thread: any
[[nodiscard]] std::filesystem::path file_of(const std::filesystem::path& picture);

/// True for a file with the first bytes of a JPEG, PNG, WebP or TIFF. thread: any
[[nodiscard]] bool begins_as_picture(const std::filesystem::path& path);

}  // namespace terrella
