#include "tests/gl/painted_source.h"

#include <utility>

namespace terrella::test {
namespace {

EncodedTile encoded(const Image& image) { return {*encode_png(image)}; }

Image square(int side) {
  return {side, side,
          std::vector<std::uint8_t>(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4, 255)};
}

class OneColour : public TileSource {
 public:
  OneColour(const TileGrid& grid, const Color& color) {
    info_.grid = grid;
    info_.format = ImageFormat::png;
    Image image = square(grid.tile_px);
    for (std::size_t k = 0; k < image.rgba.size(); ++k) {
      if (k % 4 < 3) image.rgba[k] = color[k % 4];
    }
    tile_ = encoded(image);
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
    return tile_;
  }

 private:
  TileSetInfo info_;
  EncodedTile tile_;
};

}  // namespace

PaintedSource::PaintedSource(const TileGrid& grid, Paint paint, Lacks lacks)
    : paint_(std::move(paint)), missing_(std::move(lacks)) {
  info_.grid = grid;
  info_.format = ImageFormat::png;
}

Color PaintedSource::mean(double west_deg, double north_deg, double texel_deg) const {
  int sums[3] = {};
  for (int k = 0; k < side_ * side_; ++k) {
    const double east = (k % side_ + 0.5) / side_, south = (k / side_ + 0.5) / side_;
    const Color color = paint_(west_deg + east * texel_deg, north_deg - south * texel_deg);
    for (std::size_t c = 0; c < 3; ++c) sums[c] += color[c];
  }
  const int count = side_ * side_;
  const auto rounded = [count](int sum) { return static_cast<std::uint8_t>((sum + count / 2) / count); };
  return {rounded(sums[0]), rounded(sums[1]), rounded(sums[2])};
}

Result<EncodedTile, TileFailure> PaintedSource::read(const TileId& id) {
  {
    // The end of the test must not hang on a tile that nobody releases.
    std::unique_lock lock(mutex_);
    const int place = come_++;
    if (!released_.wait_for(lock, std::chrono::seconds(60), [&] { return !held_ || place < let_through_; })) {
      return TileFailure{MissingKind::failed, "held back"};
    }
  }
  ++reads_;
  if (!exists(info_.grid, id) || (missing_ && missing_(id))) return TileFailure{MissingKind::absent, "not there"};
  const int side = info_.grid.tile_px;
  const TileBounds bounds = tile_bounds(info_.grid, id);
  const double texel_deg = (bounds.east_deg - bounds.west_deg) / side;
  Image image = square(side);
  auto* texel = image.rgba.data();
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x, texel += 4) {
      const Color color = mean(bounds.west_deg + x * texel_deg, bounds.north_deg - y * texel_deg, texel_deg);
      std::copy(color.begin(), color.end(), texel);
    }
  }
  return encoded(image);
}

void PaintedSource::hold() {
  const std::lock_guard lock(mutex_);
  held_ = true;
  let_through_ = come_;
}

void PaintedSource::release(int tiles) {
  const std::lock_guard lock(mutex_);
  let_through_ += tiles;
  released_.notify_all();
}

std::shared_ptr<TileSource> one_colour(const TileGrid& grid, const Color& color) {
  return std::make_shared<OneColour>(grid, color);
}

}  // namespace terrella::test
