// A layer of numbers against rays in double: as near to the truth as the picture of the same numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "apps/bench/truth/masked_error.h"
#include "apps/bench/truth/noise_planet.h"
#include "apps/bench/truth/ray_caster.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kTruthShot{192, 192};
constexpr int kTruthTile_px = 64, kTruthFinest = 3;
constexpr int kTruthWidth = 2 * kTruthTile_px << kTruthFinest;

/// A square of means of noise, for each level from the finest.
class NoisePyramid {
 public:
  explicit NoisePyramid(const truth::Picture& noise) {
    std::vector<double> finest;
    for (std::size_t i = 0; i < noise.rgb.size(); i += 3) finest.push_back(noise.rgb[i]);
    levels_.push_back(std::move(finest));
    for (int width = kTruthWidth / 2; width >= 2 * kTruthTile_px; width /= 2)
      levels_.push_back(halved(levels_.back(), width));
  }
  [[nodiscard]] double at(const TileId& id, int x, int y) const {
    const int width = 2 * kTruthTile_px << id.level;
    const auto column = static_cast<std::size_t>(id.x * kTruthTile_px + x),
               row = static_cast<std::size_t>(id.y * kTruthTile_px + y);
    return levels_[static_cast<std::size_t>(kTruthFinest - id.level)][row * static_cast<std::size_t>(width) + column];
  }

 private:
  static std::vector<double> halved(const std::vector<double>& from, int width) {
    const auto w = static_cast<std::size_t>(width);
    std::vector<double> to;
    for (std::size_t i = 0; i < w * w / 2; ++i) {
      const std::size_t at = (i / w) * 4 * w + (i % w) * 2;
      to.push_back(0.25 * (from[at] + from[at + 1] + from[at + 2 * w] + from[at + 2 * w + 1]));
    }
    return to;
  }
  std::vector<std::vector<double>> levels_;
};

/// The pyramid as tiles of numbers, or of grey pictures.
class NoiseTiles : public TileSource {
 public:
  NoiseTiles(std::shared_ptr<const NoisePyramid> noise, bool numbers) : noise_(std::move(noise)) {
    info_.grid = {.tile_px = kTruthTile_px, .max_level = kTruthFinest};
    info_.format = ImageFormat::png;
    if (numbers) info_.numbers = NumberInfo{.floats = true};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    EncodedTile tile;
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
    if (info_.numbers) {
      tile.make_numbers = [id, noise = noise_]() -> Result<Numbers, TileFailure> {
        Numbers made{kTruthTile_px, kTruthTile_px, {}};
        for (int k = 0; k < kTruthTile_px * kTruthTile_px; ++k) {
          made.values.push_back(static_cast<float>(noise->at(id, k % kTruthTile_px, k / kTruthTile_px)));
        }
        return made;
      };
    } else {
      tile.make_picture = [id, noise = noise_]() -> Result<Image, TileFailure> {
        Image made{kTruthTile_px, kTruthTile_px, {}};
        for (int k = 0; k < kTruthTile_px * kTruthTile_px; ++k) {
          const auto level =
              static_cast<std::uint8_t>(std::lround(noise->at(id, k % kTruthTile_px, k / kTruthTile_px)));
          made.rgba.insert(made.rgba.end(), {level, level, level, 255});
        }
        return made;
      };
    }
    return tile;
  }

 private:
  TileSetInfo info_;
  std::shared_ptr<const NoisePyramid> noise_;
};

class NumberTruth : public GlTest {
 protected:
  /// RMS over clear pixels, 8-bit levels.
  double error(const std::optional<NumberLook>& look, const Camera& camera, const truth::TruthImage& truth) {
    auto globe = Globe::create(unlit_options());
    EXPECT_TRUE(globe &&
                (*globe)->add_imagery(std::make_shared<NoiseTiles>(noise_, look.has_value()), {.numbers = look}));
    (*globe)->set_camera(camera);
    settle(**globe, kTruthShot);
    truth::Picture shot{kTruthShot.width_px, kTruthShot.height_px, {}};
    const Picture shown = picture();
    for (std::size_t k = 0; k < shown.rgba.size(); k += 4) {
      shot.rgb.insert(shot.rgb.end(), {shown.rgba[k], shown.rgba[k + 1], shown.rgba[k + 2]});
    }
    return truth::masked_error(shot, truth, truth::clear_mask(truth)).rms;
  }
  static truth::Picture grey(truth::Picture noise) {
    for (std::size_t k = 0; k < noise.rgb.size(); k += 3) noise.rgb[k + 1] = noise.rgb[k + 2] = noise.rgb[k];
    return noise;
  }
  static truth::TruthImage colored(truth::TruthImage truth, const NumberLook& look) {
    for (std::size_t k = 0; k < truth.rgb.size(); k += 3) {
      const Rgba8 color = color_of(look, static_cast<double>(truth.rgb[k]));
      truth.rgb[k] = color.r;
      truth.rgb[k + 1] = color.g;
      truth.rgb[k + 2] = color.b;
    }
    return truth;
  }
  const truth::Picture planet_ = grey(truth::noise_planet({.width = kTruthWidth, .height = kTruthWidth / 2}));
  const std::shared_ptr<const NoisePyramid> noise_ = std::make_shared<NoisePyramid>(planet_);
};

TEST_F(NumberTruth, NumbersAreAsNearToItAsAPictureIs) {
  const NumberLook plain{.low = 0.0, .high = 255.0};
  const NumberLook colors{.low = 64.0, .high = 192.0, .colors = *named_color_map("viridis")};
  for (const Camera& camera : {camera_at(5, 20, 1.9e7), camera_at(90, 0, 1.9e7), camera_at(30, 180, 6.0e6),
                               camera_at(40, 10, 1.5e6, 30, -50), camera_at(-20, 60, 4.0e5)}) {
    const truth::TruthCamera rays{.eye = {camera.eye.lat.deg(), camera.eye.lon.deg(), camera.eye.height_m},
                                  .heading_deg = camera.heading.deg(),
                                  .pitch_deg = camera.pitch.deg(),
                                  .fov_deg = camera.fov_y.deg()};
    const auto truth =
        truth::cast(planet_, {}, {}, rays, {.width = kTruthShot.width_px, .height = kTruthShot.height_px});
    const double picture = error({}, camera, truth), numbers = error(plain, camera, truth);
    const double mapped = error(colors, camera, colored(truth, colors));
    fmt::print(
        "{:5.0f} N {:5.0f} E {:9.0f} m: picture {:.3f}, numbers in grey {:.3f}, in viridis of half the range {:.3f}\n",
        camera.eye.lat.deg(), camera.eye.lon.deg(), camera.eye.height_m, picture, numbers, mapped);
    EXPECT_LE(numbers, picture + 0.02);
    // The stretch doubles every difference, and viridis has no steeper part than twice the grey's.
    EXPECT_LE(mapped, 4.0 * numbers + 0.5);
  }
}

}  // namespace
}  // namespace terrella::test
