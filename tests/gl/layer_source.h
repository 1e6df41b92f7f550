#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "tiles/tile_source.h"

namespace terrella::test {

using Rgba = std::array<std::uint8_t, 4>;

/// Tiles with transparency, painted when they are asked for: not premultiplied, as PNG has them.
class LayerSource : public TileSource {
 public:
  /// The colour of a texel's centre by longitude and row latitude, degrees. thread: worker
  using Paint = std::function<Rgba(double lon_deg, double row_deg)>;
  using Lacks = std::function<bool(const TileId&)>;

  LayerSource(const TileGrid& grid, Paint paint, Lacks lacks = {});
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  void set_attribution(std::string text) { info_.attribution = std::move(text); }  ///< before a globe has it
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override;

 private:
  TileSetInfo info_;
  Paint paint_;
  Lacks missing_;
};

}  // namespace terrella::test
