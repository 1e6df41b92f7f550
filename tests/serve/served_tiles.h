#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/serve/served_set.h"
#include "apps/serve/web_request.h"
#include "codecs/image.h"
#include "streaming/file_bytes.h"
#include "tiles/tile_source.h"

namespace terrella::test {

inline constexpr int kTilePx = 16;

/// A geodetic set with two root tiles.
inline TileSetInfo geodetic_info() {
  return {.name = "Geo",
          .attribution = "",
          .body = "",
          .grid = {.root_span_deg = 180.0, .tile_px = kTilePx, .max_level = 3},
          .format = ImageFormat::png};
}

inline TileSetInfo web_info() {
  TileSetInfo info = geodetic_info();
  info.grid.projection = Projection::web_mercator;
  info.grid.root_span_deg = 360.0;
  return info;
}

/// Tiles that name their places behind the end of their picture, which decoders ignore. Counts reads beyond the grid.
class NamedTiles : public TileSource {
 public:
  explicit NamedTiles(TileSetInfo info) : info_(std::move(info)) {
    const Image image{
        .width_px = kTilePx, .height_px = kTilePx, .rgba = std::vector<std::uint8_t>(kTilePx * kTilePx * 4, 255)};
    png_ = encode_png(image).value();
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    const TileGrid& grid = info_.grid;
    const bool inside = id.level >= grid.min_level && id.level <= grid.max_level && id.x >= 0 && id.y >= 0 &&
                        id.x < columns(grid, id.level) && id.y < rows(grid, id.level);
    if (!inside) ++strays;
    if (failure) return *failure;
    std::vector<std::byte> bytes = png_;
    for (const char c : mark(id)) bytes.push_back(static_cast<std::byte>(c));
    if (is_cut_short) bytes.resize(bytes.size() / 2);
    return EncodedTile{.bytes = std::move(bytes)};
  }
  static std::string mark(const TileId& id) {
    return std::to_string(id.level) + "/" + std::to_string(id.x) + "/" + std::to_string(id.y);
  }

  std::optional<TileFailure> failure;
  bool is_cut_short = false;
  std::atomic<int> strays = 0;

 private:
  const TileSetInfo info_;
  std::vector<std::byte> png_;
};

inline std::string_view text(const WebAnswer& answer) { return as_text(answer.bytes); }

}  // namespace terrella::test
