#pragma once

#include <memory>
#include <string>

#include "streaming/raster/byte_file.h"

namespace terrella {

/// A file of GDAL's virtual file system whose bytes come from a ByteFile, so that GDAL reads files of servers through
/// our requests, limits and cache. The file is there while the object lives. thread: any
class GdalMount {
 public:
  /// GDAL must be loaded.
  explicit GdalMount(std::shared_ptr<const ByteFile> bytes);
  ~GdalMount();
  GdalMount(const GdalMount&) = delete;
  GdalMount& operator=(const GdalMount&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }  ///< GDAL's name of the file

 private:
  std::string name_, path_;
};

}  // namespace terrella
