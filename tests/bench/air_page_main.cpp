// Six scenes as the globe draws them, and as marched rays show them, as pairs of PNG files. The ground's own colours in
// the truth are those of the globe without air. Its rays meet relief by steps through the loaded heights.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <stdexcept>
#include <string>

#include "codecs/image.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"
#include "sky/almanac.h"
#include "streaming/sets/open_tile_set.h"
#include "tests/gl/painted_source.h"
#include "tests/globe/air_truth.h"

namespace {

using namespace terrella;
using Clock = std::chrono::steady_clock;

struct Scene {
  const char *name, *body, *camera, *time;
  bool relief = false;
};

constexpr Viewport kSize{240, 180};
constexpr int kTimes = 8, kTimesOverRelief = 2;  // rays through heights take long
constexpr Scene kScenes[] = {{"disc", "earth", "15,20,18000000", "2026-06-21T10:30Z"},
                             {"terminator", "earth", "25,60,12000000", "2026-03-20T15:30Z"},
                             {"horizon", "earth", "35,15,400000,60,-20,40", "2026-06-21T10:00Z"},
                             {"alps", "earth", "45.4,6.2,30000,40,-12,50", "2026-06-21T18:40Z", true},
                             {"pole", "earth", "78,-20,1500000,0,-52,50", "2026-06-21T14:00Z"},
                             {"moon", "moon", "0,0,12000000,0,-90,22", "2026-03-03T11:40Z"}};

template <class T>
T value_or_throw(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

test::Color maria(double lon, double lat) {
  const double a = std::sin(lon * 0.06 + 1.0) * std::cos(lat * 0.07), b = std::sin(lon * 0.31) * std::sin(lat * 0.27);
  const auto grey = static_cast<std::uint8_t>((a > 0.35 ? 110 : 175) + 15.0 * b);
  return {grey, grey, grey};
}

/// The ground of a scene, for rays in double: the ellipsoid, or the heights over it.
class GroundTruth {
 public:
  GroundTruth(const Globe& globe, const Ellipsoid& ellipsoid, bool relief)
      : globe_(globe), ellipsoid_(ellipsoid), relief_(relief) {}

  /// Distance to the ground; none: the ray meets only sky.
  [[nodiscard]] std::optional<double> hit_m(const Ecef& eye, const EcefDir& ray) const {
    if (!relief_) return ellipsoid_.intersect_m(eye, ray);
    double before_m = 0.0;
    for (double at_m = 0.0; at_m < kFarthest_m;) {
      const double over_m = clearance_m(eye, ray, at_m);
      if (over_m <= 0.0) return crossing_m(eye, ray, before_m, at_m);
      before_m = at_m;
      at_m += std::max(kStep_m, kClearPart * over_m);
    }
    return std::nullopt;
  }

 private:
  // Slopes of the Alps reach 2; a step of this part of the height over the ground cannot pass through one.
  static constexpr double kFarthest_m = 1.0e6, kStep_m = 20.0, kClearPart = 0.3, kExact_m = 0.1;

  [[nodiscard]] double clearance_m(const Ecef& eye, const EcefDir& ray, double at_m) const {
    const Geodetic place = ellipsoid_.to_geodetic(Ecef{eye.xyz_m + at_m * ray.xyz});
    return place.height_m - globe_.ground_height_m(place.lat, place.lon);
  }
  [[nodiscard]] double crossing_m(const Ecef& eye, const EcefDir& ray, double over_m, double under_m) const {
    while (under_m - over_m > kExact_m) {
      const double middle_m = 0.5 * (over_m + under_m);
      (clearance_m(eye, ray, middle_m) > 0.0 ? over_m : under_m) = middle_m;
    }
    return under_m;
  }

  const Globe& globe_;
  const Ellipsoid& ellipsoid_;
  bool relief_;
};

/// A picture and its view.
struct Drawn {
  Image image;
  View view;
  [[nodiscard]] glm::dvec3 at(const glm::ivec2& px) const {
    const auto k = static_cast<std::size_t>(4 * (px.y * image.width_px + px.x));
    return {image.rgba[k], image.rgba[k + 1], image.rgba[k + 2]};
  }
};

class Page {
 public:
  Page(std::string tiles, std::string elevation, std::string folder)
      : tiles_(std::move(tiles)), elevation_(std::move(elevation)), folder_(std::move(folder)) {}

  void make(const Scene& scene) {
    const Body body = value_or_throw(parse_body(scene.body));
    const auto air = atmosphere_of(body);
    const auto globe = globe_of(scene, body, false);
    save(scene, "ours", drawn(*globe, kSize).image);
    SurfaceLook dull;
    dull.glint = false;
    globe->set_surface(dull);
    globe->set_sky(false);
    const Drawn own = air ? drawn(*globe, kSize) : drawn(*globe_of(scene, body, true), kSize);
    const Almanac almanac = value_or_throw(almanac_at(value_or_throw(parse_utc(scene.time))));
    save(scene, "truth",
         air ? through_air(own, drawn(*globe, larger(scene.relief)),
                           {*globe, body.ellipsoid, scene.relief && !elevation_.empty()},
                           test::AirTruth(*air, body.ellipsoid), almanac.sun.xyz)
             : dust(own.image, own.view, body, body_sun(body, scene)));
  }

 private:
  static EcefDir body_sun(const Body&, const Scene& scene) {
    return value_or_throw(almanac_at(value_or_throw(parse_utc(scene.time)))).sun;
  }
  std::unique_ptr<Globe> globe_of(const Scene& scene, const Body& body, bool unlit) {
    GlobeOptions options;
    options.body = body;
    options.sky = !unlit;
    options.unlit = unlit;
    if (!unlit) options.time = value_or_throw(parse_utc(scene.time));
    std::shared_ptr<TileSource> source;
    if (body.name == "moon") {
      source = std::make_shared<test::PaintedSource>(TileGrid{.tile_px = 128, .max_level = 3}, maria);
    } else {
      source = value_or_throw(open_tile_set(tiles_));
    }
    std::optional<ElevationSource> heights;
    if (scene.relief && !elevation_.empty()) {
      heights = value_or_throw(
          ElevationSource::open(std::shared_ptr<TileSource>(value_or_throw(open_tile_set(elevation_))), "heights"));
    }
    auto globe = value_or_throw(Globe::create(options, source, std::move(heights)));
    Camera camera = value_or_throw(parse_camera(scene.camera));
    if (body.name == "moon") {
      const Geodetic below = Ellipsoid::lat_lon(body_sun(body, scene));
      camera.eye.lat = below.lat;
      camera.eye.lon = below.lon;
    }
    globe->set_camera(camera);
    return globe;
  }
  static Drawn drawn(Globe& globe, Viewport size) {
    const OffscreenTarget target{size};
    if (!globe.render_until_settled(target.framebuffer(), size, Clock::now() + std::chrono::minutes(3)))
      throw std::runtime_error("the globe has not settled after three minutes");
    globe.render(target.framebuffer(), size);
    return {{size.width_px, size.height_px, target.read()}, globe.view(size)};
  }
  static Viewport larger(bool relief) {
    const int times = relief ? kTimesOverRelief : kTimes;
    return {times * kSize.width_px, times * kSize.height_px};
  }
  static bool on_limb(const View& view, const GroundTruth& true_ground, const glm::dvec2& px) {
    int ground = 0;
    for (const glm::dvec2& corner : {glm::dvec2(-1, -1), glm::dvec2(2, -1), glm::dvec2(-1, 2), glm::dvec2(2, 2)}) {
      ground += true_ground.hit_m(view.eye, pixel_ray(view, px + corner)) ? 1 : 0;
    }
    return ground != 0 && ground != 4;
  }
  /// The ground's own colour at a ray of the larger picture, whose pixels on the limb are mixed with what is behind it:
  /// there the colour of the nearest pixel that is ground throughout.
  static glm::dvec3 own_color(const Drawn& own, const GroundTruth& ground, const glm::ivec2& px) {
    constexpr int kReach_px = 3, kSide = 2 * kReach_px + 1;
    glm::ivec2 best = px;
    int least = on_limb(own.view, ground, glm::dvec2(px)) ? kSide * kSide : 0;
    for (int k = 0; least > 0 && k < kSide * kSide; ++k) {
      const glm::ivec2 off(k % kSide - kReach_px, k / kSide - kReach_px), at = px + off;
      const int far = off.x * off.x + off.y * off.y;
      if (far >= least ||
          at != glm::clamp(at, glm::ivec2(0), glm::ivec2(own.image.width_px - 1, own.image.height_px - 1)))
        continue;
      if (on_limb(own.view, ground, glm::dvec2(at)) ||
          !ground.hit_m(own.view.eye, pixel_ray(own.view, glm::dvec2(at) + 0.5)))
        continue;
      best = at, least = far;
    }
    return own.at(best);
  }
  /// A ray through the middle of each pixel, and one through each pixel of the larger picture on the limb.
  static Image through_air(const Drawn& own, const Drawn& large, const GroundTruth& ground, const test::AirTruth& truth,
                           const glm::dvec3& sun) {
    Image out = own.image;
    for (int k = 0; k < kSize.width_px * kSize.height_px; ++k) {
      const glm::ivec2 px(k % kSize.width_px, k / kSize.width_px);
      const bool limb = on_limb(own.view, ground, glm::dvec2(px));
      const Drawn& picture = limb ? large : own;
      const int side = picture.image.width_px / kSize.width_px;
      glm::dvec3 sum(0.0);
      for (int r = 0; r < side * side; ++r) {
        const glm::ivec2 at = side * px + glm::ivec2(r % side, r / side);
        const glm::dvec3 ray = pixel_ray(picture.view, glm::dvec2(at) + 0.5).xyz, eye_m = picture.view.eye.xyz_m;
        const auto metres = ground.hit_m(picture.view.eye, EcefDir{ray});
        const auto ground_color = [&] { return side == kTimes ? own_color(large, ground, at) : picture.at(at); };
        sum += metres ? truth.thing(eye_m, ray, *metres, sun,
                                    ground_color() * truth.ground_tint(eye_m + *metres * ray, sun))
                      : truth.color(eye_m, ray, sun, 0.0);
      }
      for (std::size_t c = 0; c < 3; ++c)
        out.rgba[static_cast<std::size_t>(4 * k) + c] =
            static_cast<std::uint8_t>(std::clamp(sum[int(c)] / (side * side) + 0.5, 0.0, 255.0));
    }
    return out;
  }
  /// McEwen's lunar-Lambert law, in double, at a full phase of the angle between Sun and eye.
  static Image dust(const Image& own, const View& view, const Body& body, const EcefDir& sun) {
    Image out = own;
    for (int k = 0; k < kSize.width_px * kSize.height_px; ++k) {
      const glm::dvec3 ray = pixel_ray(view, {k % kSize.width_px + 0.5, k / kSize.width_px + 0.5}).xyz;
      const auto metres = body.ellipsoid.intersect_m(view.eye, EcefDir{ray});
      double light = 0.0;
      if (metres) {
        const glm::dvec3 normal = glm::normalize(view.eye.xyz_m + *metres * ray);
        const double in = glm::dot(normal, sun.xyz), seen = glm::dot(normal, -ray);
        const double phase = glm::degrees(std::acos(std::clamp(glm::dot(sun.xyz, -ray), -1.0, 1.0)));
        const double part = std::clamp(1.0 + phase * (-0.019 + phase * (0.242e-3 - 1.46e-6 * phase)), 0.0, 1.0);
        light = in <= 0.0 ? 0.02 : 0.02 + 0.98 * (part * 2.0 * in / (in + seen) + (1.0 - part) * in);
      }
      for (std::size_t c = 0; c < 3; ++c) {
        auto& value = out.rgba[static_cast<std::size_t>(4 * k) + c];
        value = static_cast<std::uint8_t>(std::min(255.0, value * light + 0.5));
      }
    }
    return out;
  }
  void save(const Scene& scene, const char* which, const Image& image) const {
    const std::vector<std::byte> bytes = value_or_throw(encode_png(image));
    std::ofstream file(fmt::format("{}/{}_{}.png", folder_, scene.name, which), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file) throw std::runtime_error(fmt::format("cannot write into {}", folder_));
  }
  std::string tiles_, elevation_, folder_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Six scenes beside marched rays");
  std::string tiles, elevation, folder = ".", only;
  app.add_option("--tiles", tiles, "tile set of the Earth")->required();
  app.add_option("--elevation", elevation, "tile set of heights, for the Alps");
  app.add_option("--out", folder, "folder for the pictures");
  app.add_option("--only", only, "one scene");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto context = value_or_throw(HeadlessContext::create());
    Page page(tiles, elevation, folder);
    for (const Scene& scene : kScenes) {
      if (only.empty() || only == scene.name) page.make(scene);
    }
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "{}\n", wrong.what());
    return 1;
  }
  return 0;
}
