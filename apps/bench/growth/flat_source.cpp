#include "apps/bench/growth/flat_source.h"

#include "codecs/image.h"

namespace terrella::bench {
namespace {

constexpr int kFlatSide_px = 256;

class FlatSource : public TileSource {
 public:
  explicit FlatSource(int max_level) {
    info_.name = "flat";
    info_.grid = {.root_span_deg = 180.0, .tile_px = kFlatSide_px, .max_level = max_level};
    info_.format = ImageFormat::png;
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the grid"};
    return EncodedTile{.bytes = flat_tile()};
  }

 private:
  TileSetInfo info_;
};

}  // namespace

const std::vector<std::byte>& flat_tile() {
  static const std::vector<std::byte> png = [] {
    Image image{kFlatSide_px, kFlatSide_px, {}};
    image.rgba.assign(4UL * kFlatSide_px * kFlatSide_px, 160);
    for (std::size_t alpha = 3; alpha < image.rgba.size(); alpha += 4) image.rgba[alpha] = 255;
    return encode_png(image).value();
  }();
  return png;
}

std::shared_ptr<TileSource> make_flat_source(int max_level) { return std::make_shared<FlatSource>(max_level); }

}  // namespace terrella::bench
