#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "streaming/raster/raster_source.h"

struct pj_ctx;
struct PJconsts;

namespace terrella::test {

/// The value of the ground at a place, degrees, in [0, 255].
using Ground = std::function<double(double lat_deg, double lon_deg)>;

/// Place of a point of a coordinate system, degrees, by PROJ itself. Not a place: infinite.
class Places {
 public:
  explicit Places(const std::string& proj_string);
  ~Places();
  Places(const Places&) = delete;
  Places& operator=(const Places&) = delete;
  struct Place {
    double lat_deg, lon_deg;
  };
  [[nodiscard]] Place of(double x, double y) const;

 private:
  pj_ctx* context_;
  PJconsts* path_;
};

struct PaintedOptions {
  std::string crs;  ///< a PROJ string with "+type=crs" left out
  Affine to_crs;
  std::int64_t width_px = 0, height_px = 0;
  int block_px = 64;
  int overviews = 0;
  bool numbers = false;
  int rays = 4;  ///< the value of a pixel of the finest level is the mean of so many places a side
};

/// A raster in any coordinate system, painted as it is read: each pixel the mean of its places. Red goes by the first
/// planet, green by the second; numbers by the first. Pixels without a place are transparent or NaN.
class PaintedRaster : public RasterSource {
 public:
  PaintedRaster(const PaintedOptions& options, Ground red, Ground green);

  [[nodiscard]] const RasterInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& block) override;

  RasterInfo& change() { return info_; }
  void note_missing(const TileId& id, MissingKind kind) { missing_[id] = kind; }
  [[nodiscard]] std::map<TileId, int> reads();

 private:
  [[nodiscard]] Image paint(const TileId& block) const;

  const PaintedOptions options_;
  const Ground red_, green_;
  RasterInfo info_;
  std::map<TileId, MissingKind> missing_;
  std::mutex mutex_;  ///< guards reads_
  std::map<TileId, int> reads_;
};

}  // namespace terrella::test
