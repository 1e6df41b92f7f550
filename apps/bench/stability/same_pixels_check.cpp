#include <cmath>
#include <cstdint>

#include "apps/bench/stability/check.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella::bench {
namespace {

constexpr Viewport kTwicePicture{512, 512};
constexpr std::chrono::seconds kPatience{60};

/// Tiles with a different value in every texel, identical in every run.
class SpeckledTiles : public TileSource {
 public:
  SpeckledTiles() {
    info_.grid.tile_px = 64;
    info_.grid.max_level = 6;
    info_.format = ImageFormat::png;
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the grid"};
    const int side = info_.grid.tile_px;
    Image image{side, side,
                std::vector<std::uint8_t>(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4, 255)};
    auto seed = static_cast<std::uint32_t>(TileIdHash{}(id));
    for (std::size_t k = 0; k < image.rgba.size(); ++k) {
      seed = seed * 1664525U + 1013904223U;
      if (k % 4 < 3) image.rgba[k] = static_cast<std::uint8_t>(seed >> 24U);
    }
    Result<std::vector<std::byte>> bytes = encode_png(image);
    if (!bytes) return TileFailure{MissingKind::failed, bytes.error().message};
    return EncodedTile{*std::move(bytes)};
  }

 private:
  TileSetInfo info_;
};

Result<std::vector<std::uint8_t>> picture_of(const Camera& camera) {
  auto globe = Globe::create({}, std::make_shared<SpeckledTiles>());
  if (!globe) return globe.error();
  const OffscreenTarget target(kTwicePicture);
  (*globe)->set_camera(camera);
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  if (!(*globe)->render_until_settled(target.framebuffer(), kTwicePicture, deadline)) {
    return Error{"the globe has not settled within a minute"};
  }
  (*globe)->render(target.framebuffer(), kTwicePicture);
  return target.read();
}

struct Place {
  const char* name;
  Camera camera;
};

}  // namespace

// Draws two globes in sequence; the second finds nothing of the first.
Status check_same_pixels(const StabilityOptions& options, Checks& checks) {
  const auto camera = [](double lat_deg, double lon_deg, double height_m, double pitch_deg) {
    return Camera{.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m},
                  .pitch = Angle::degrees(pitch_deg)};
  };
  const Place places[] = {{"mid latitude", camera(30.0, 20.0, 6.0e6, -90.0)},
                          {"pole, tilted", camera(80.0, 10.0, 1.5e6, -45.0)},
                          {"antimeridian", camera(0.0, 180.0, 6.0e6, -90.0)}};
  for (const Place& place : places) {
    Status failed = Done{};
    checks.push_back(timed({.test = "same pixels twice", .subject = place.name, .unit = "pixels", .limit = 0.0}, [&] {
      const auto once = picture_of(place.camera), again = picture_of(place.camera);
      if (!once || !again) {
        failed = !once ? once.error() : again.error();
        return HUGE_VAL;
      }
      double different = 0.0;
      for (std::size_t k = 0; k < once->size(); k += 4) {
        different += std::equal(&(*once)[k], &(*once)[k] + 4, &(*again)[k]) ? 0.0 : 1.0;
      }
      return different;
    }));
    if (!failed) return failed;
    if (options.quick) break;
  }
  return Done{};
}

}  // namespace terrella::bench
