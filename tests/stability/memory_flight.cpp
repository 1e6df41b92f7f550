#include "memory_flight.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tests/gl/painted_heights.h"
#include "view/flight.h"

namespace terrella::test {
namespace {

constexpr TileGrid kImageGrid{.tile_px = 64, .max_level = 18};
constexpr TileGrid kGroundGrid{.tile_px = 32, .max_level = 14};
constexpr double kMegabyte = 1024.0 * 1024.0;

// Up and down between -1 and 1 as often as asked in a radian; cheaper than a sine.
double zigzag(double rad, double times) {
  const double turns = rad * times * (0.5 * std::numbers::inv_pi);
  return 4.0 * std::abs(turns - std::round(turns)) - 1.0;
}

// A continent's waves and a street's: every tile has something of its own.
double waves(double lat_rad, double lon_rad) {
  return zigzag(lat_rad, 9.0) * zigzag(lon_rad, 8.0) + 0.05 * zigzag(lat_rad, 3.0e4) * zigzag(lon_rad, 2.0e4);
}

double ground_at_m(double lat_rad, double lon_rad) { return 1000.0 * waves(lat_rad, lon_rad); }

template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

/// Every tile that its grid has, of a few colours: what a tile costs is its decoding.
class ColouredTiles : public TileSource {
 public:
  explicit ColouredTiles(std::uint8_t alpha) {
    info_.grid = kImageGrid;
    info_.format = ImageFormat::png;
    for (int k = 0; k < kColours; ++k) {
      Image image{kImageGrid.tile_px, kImageGrid.tile_px, {}};
      image.rgba.assign(4UL * kImageGrid.tile_px * kImageGrid.tile_px, static_cast<std::uint8_t>(30 * k));
      for (std::size_t a = 3; a < image.rgba.size(); a += 4) image.rgba[a] = alpha;
      tiles_.push_back(value_of(encode_png(image)));
    }
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
    return EncodedTile{tiles_[static_cast<std::size_t>(id.level + id.x + 3 * id.y) % kColours]};
  }

 private:
  static constexpr int kColours = 8;
  TileSetInfo info_;
  std::vector<std::vector<std::byte>> tiles_;
};

double resident_mb() {
  std::ifstream pages("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  pages >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / kMegabyte;
}

double heap_mb() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / kMegabyte;
}

}  // namespace

MemoryFlight::MemoryFlight(Viewport size, int frames_of_leg, unsigned seed)
    : size_(size), frames_of_leg_(frames_of_leg), random_(seed), target_(size) {
  GlobeOptions options;
  options.gpu_bytes = kGpuBytes;
  options.height_bytes = kHeightBytes;
  options.workers = 1;
  options.segments = 16;
  options.relief_meshes_per_frame = 8;
  globe_ = value_of(Globe::create(options, std::make_shared<ColouredTiles>(255),
                                  value_of(ElevationSource::open(painted_heights(kGroundGrid, ground_at_m), "waves"))));
  Camera camera;
  camera.eye.height_m = 2.0e7;
  globe_->set_camera(camera);
}

// A pole, ±180° or anywhere; from orbit to a street.
Camera MemoryFlight::next_end() {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Camera end;
  end.eye.lat = Angle::radians(std::asin(2.0 * unit(random_) - 1.0));
  end.eye.lon = Angle::degrees(360.0 * unit(random_) - 180.0);
  end.heading = Angle::degrees(360.0 * unit(random_));
  constexpr double kHeights_m[] = {2.0e7, 300.0, 2.0e5, 1.0e5, 3.0e4, 2000.0};
  constexpr double kPitches_deg[] = {-90.0, -25.0, -5.0, -60.0, -30.0, -10.0};
  const int kind = legs_ % 6;
  if (kind == 3) end.eye.lat = Angle::degrees(legs_ % 4 < 2 ? 89.99 : -89.99);
  if (kind == 4) end.eye.lon = Angle::degrees(legs_ % 4 < 2 ? 179.999 : -179.999);
  end.eye.height_m = kHeights_m[kind] + std::max(0.0, ground_at_m(end.eye.lat.rad(), end.eye.lon.rad()));
  end.pitch = Angle::degrees(kPitches_deg[kind]);
  return end;
}

void MemoryFlight::change_layers() {
  if (legs_ % 7 == 3 && above_ != LayerId::none) {
    value_of(globe_->remove(above_));
    above_ = LayerId::none;
  } else if (above_ == LayerId::none) {
    above_ = value_of(globe_->add_imagery(std::make_shared<ColouredTiles>(160), {.opacity = 0.5}));
  }
  ObjectScene scene;
  for (int k = 0; k < 50 + legs_ % 50; ++k) {
    const Camera place = next_end();
    scene.points.push_back({.place = place.eye});
  }
  if (objects_ == LayerId::none) {
    objects_ = value_of(globe_->add_objects(std::move(scene)));
  } else {
    value_of(globe_->set_objects(objects_, std::move(scene)));
  }
}

MemorySample MemoryFlight::fly() {
  change_layers();
  const Flight leg = plan_flight(globe_->camera(), next_end(), globe_->options().body.ellipsoid);
  MemorySample sample;
  for (int k = 1; k <= frames_of_leg_; ++k) {
    globe_->set_camera(flight_camera(leg, leg.duration * (static_cast<double>(k) / frames_of_leg_)));
    sample.last = globe_->render(target_.framebuffer(), size_);
    sample.uncovered += sample.last.patches_uncovered > 0 ? 1 : 0;
    sample.most_held = std::max(sample.most_held, sample.last.patches_held);
    sample.most_known = std::max(sample.most_known, sample.last.tiles_known);
  }
  ++legs_;
  frames_ += frames_of_leg_;
  sample.frames = frames_;
  sample.resident_mb = resident_mb();
  sample.heap_mb = heap_mb();
  sample.finished = globe_->loading().finished;
  return sample;
}

}  // namespace terrella::test
