#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/result.h"
#include "streaming/objects/vector/kml_file.h"
#include "streaming/raster/gdal/gdal_library.h"

namespace terrella {

struct CloseVectorFile {
  void operator()(GDALDatasetH dataset) const { gdal().GDALClose(dataset); }
};

/// An open vector file, used by one thread at a time.
struct VectorFile {
  std::unique_ptr<void, CloseVectorFile> dataset;
  std::string driver;      ///< GDAL's name of the format
  bool is_kml = false;     ///< KML or KMZ
  bool has_links = false;  ///< KML with links to features, or to a network, which are not followed
};

/// True for the name of a file whose format is a ZIP file: KMZ, and shapefiles in one. thread: any
[[nodiscard]] bool is_zip_name(const std::filesystem::path& path);
/// Settings that must hold while a vector file is opened and read: shared styles of KML count, styles elsewhere do not.
[[nodiscard]] GdalSettings::Settings vector_settings();
/// The driver that may open a file of this name; null if none may. thread: any
[[nodiscard]] const char* vector_driver_of(const std::filesystem::path& path);
/// Fails if a file is longer than kMaxVectorUnpackedBytes or kMaxObjectFileBytes allow, also when unpacked. GDAL is
/// loaded. The error does not name the file. Blocks. thread: any
[[nodiscard]] Status check_vector_length(const std::filesystem::path& path);
/// Opens a vector file by that driver alone. The error names the file. Blocks. thread: any
[[nodiscard]] Result<VectorFile> open_vector_file(const std::filesystem::path& path);

}  // namespace terrella
