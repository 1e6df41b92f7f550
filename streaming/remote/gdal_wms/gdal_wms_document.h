#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The window of a GDAL_WMS raster: its corners in its coordinate system, and its pixels at the finest level.
struct GdalWindow {
  double west = 0.0, north = 0.0, east = 0.0, south = 0.0;
  std::int64_t width_px = 0, height_px = 0;
  int block_px = 0;
  int level = 0;              ///< the server's name of the finest level
  int overviews = 0;          ///< coarser levels
  std::int64_t column_0 = 0;  ///< the server's column and row of the window's first tile, at the finest level
  std::int64_t row_0 = 0;
  bool rows_from_south = false;
  [[nodiscard]] double pixel() const { return (east - west) / static_cast<double>(width_px); }
};

/// A GDAL_WMS description as written, with numbers checked for range and all that cannot be read refused.
struct GdalWmsDocument {
  enum class Service { tms, virtual_earth, wms };
  Service service = Service::tms;
  std::string server_url{};
  std::string version{}, layer{}, format{};  ///< values of a TMS; `version` also of a WMS
  std::string layers{}, styles{};            ///< values of a WMS, decoded
  std::string image_format{};
  bool transparent = false;
  bool northing_first = false;  ///< BBoxOrder yxYX
  std::string crs{};            ///< text for Crs::open()
  std::string request_crs{};    ///< value of SRS or CRS in requests of a WMS
  GdalWindow window{};
  std::optional<NumberInfo> numbers{};  ///< numbers; none: pictures
  std::vector<int> missing_statuses{};
  bool exception_is_missing = false;
  std::string referer{};
  std::string user_and_password{};  ///< secret
  std::optional<std::chrono::seconds> timeout{};
  std::optional<std::chrono::seconds> tile_life{};
  int connections = 0;
};

/// Limit on a description.
inline constexpr std::size_t kMaxGdalWmsBytes = 1UL << 20;

/// Reads a GDAL_WMS document (https://gdal.org/en/stable/drivers/raster/wms.html), with the defaults of GDAL 3. A
/// value may be an element or an attribute, in letters of any case. The error is the reason alone and says what to
/// change. thread: any
[[nodiscard]] Result<GdalWmsDocument> read_gdal_wms(std::string_view xml);

}  // namespace terrella
