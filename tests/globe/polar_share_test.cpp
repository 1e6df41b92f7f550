// The part of a picture that the program with coordinates per fragment draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "render/gl/shader_library.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kSharePicture{1024, 1024};
/// As `terrella cut` makes them: with squeezed rows.
const TileGrid kShareGrid{.tile_px = 256, .max_level = 14, .reduced = true};

/// Programs that draw white where coordinates are computed per fragment, and black elsewhere.
class MaskShaders {
 public:
  MaskShaders() {
    std::filesystem::create_directories(folder_ / "surface");
    for (const std::string_view program :
         {"polar_short", "polar", "polar_long", "plain", "long", "oblique", "magnified"}) {
      std::ofstream(folder_ / "surface" / ("patch_" + std::string(program) + ".frag"))
          << "void main() { color_srgb = vec4(vec3(" << (program.starts_with("polar") ? 1.0 : 0.0) << "), 1.0); }\n";
    }
    read_shaders_from(folder_);
  }
  ~MaskShaders() {
    read_shaders_from({});
    std::filesystem::remove_all(folder_);
  }
  MaskShaders(const MaskShaders&) = delete;
  MaskShaders& operator=(const MaskShaders&) = delete;

 private:
  std::filesystem::path folder_ = testing::TempDir() + "polar_share";
};

class PolarShare : public GlTest {
 protected:
  /// Part of the picture's pixels. Tiles need not be there: the choice of a program does not depend on them.
  double share(Globe& globe, const Camera& camera) {
    globe.set_camera(camera);
    draw(globe, kSharePicture);
    const std::vector<std::uint8_t>& rgba = picture().rgba;
    std::size_t white = 0;
    for (std::size_t k = 0; k < rgba.size(); k += 4) white += rgba[k] > 127 ? 1 : 0;
    return static_cast<double>(white) / static_cast<double>(rgba.size() / 4);
  }
};

TEST_F(PolarShare, IsSmallInRandomViewsAndAtThePoles) {
  const MaskShaders masks;
  const auto globe = make_globe(unlit_options(), one_colour(kShareGrid, {0, 0, 0}));
  Draw draw(61);
  double sum = 0.0, most = 0.0;
  constexpr int kViews = 200;
  for (int k = 0; k < kViews; ++k) {
    Camera camera = random_camera(draw, 1.0e3, 1.0e8);
    // Every second view looks at a pole's surroundings, from as far as its height.
    if (k % 2 == 0) {
      const double around_deg = std::min(60.0, camera.eye.height_m / 1.0e5);
      camera.eye.lat = Angle::degrees((draw.whole(0, 1) == 0 ? 1.0 : -1.0) * (90.0 - draw.between(0.0, around_deg)));
      camera.pitch = Angle::degrees(draw.between(-90.0, -45.0));
      camera.fov_y = Angle::degrees(draw.between(20.0, 70.0));
    }
    const double part = share(*globe, camera);
    sum += part;
    most = std::max(most, part);
    EXPECT_LT(part, 0.08) << camera.eye.lat.deg() << "," << camera.eye.lon.deg() << "," << camera.eye.height_m << ","
                          << camera.heading.deg() << "," << camera.pitch.deg() << "," << camera.fov_y.deg();
  }
  std::cout << "mean " << sum / kViews << ", most " << most << "\n";
  EXPECT_LT(sum / kViews, 0.02);
  EXPECT_GT(most, 0.0) << "no view had a pixel of the program";
}

}  // namespace
}  // namespace terrella::test
