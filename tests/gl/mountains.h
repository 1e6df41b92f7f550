#pragma once

#include "tests/gl/gl_fixture.h"

namespace terrella::test {

/// Mountains up to this and basins down to the same, not exaggerated, metres.
inline constexpr double kMost_m = 5000.0;

/// Mountains 20° apart, which a grid of a third of a degree follows within 8 m; with more waves nearer together.
[[nodiscard]] double mountain_m(double lat_rad, double lon_rad, double waves = 18.0);

/// The heights as 16-bit tiles, as the cutter writes them: number - 32768 is the height in quarters of a metre.
class Mountains : public TileSource {
 public:
  explicit Mountains(double waves = 18.0);
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override;

 private:
  TileSetInfo info_;
  double waves_;
};

/// A globe of mountains that takes all heights at once; a failure of the test if there is none.
[[nodiscard]] std::unique_ptr<Globe> mountainous_globe(const GlobeOptions& options, std::shared_ptr<TileSource> imagery,
                                                       double waves = 18.0);

}  // namespace terrella::test
