#include "apps/bench/truth/noise_planet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

namespace terrella::truth {
namespace {

struct Octave {
  double spacing_texels;  // lattice width, in texels at the equator
  float amplitude_levels;
};
// Calibrated, see the header. A filter may blur the finest octave but must not alias.
constexpr std::array<Octave, 6> kOctaves{{{2.0, 17}, {4.0, 17}, {8.0, 16}, {16.0, 18}, {32.0, 24}, {64.0, 34}}};
constexpr float kMeanLevel = 127.5F;

struct Rgb {
  std::array<float, 4> c{};  // the fourth is padding, so that one register holds all
};

Rgb mix(const Rgb& a, const Rgb& b, float t) {
  Rgb out;
  for (std::size_t i = 0; i < 4; ++i) out.c[i] = a.c[i] + t * (b.c[i] - a.c[i]);
  return out;
}

std::uint32_t scramble(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352dU;
  h ^= h >> 15;
  h *= 0x846ca68bU;
  return h ^ (h >> 16);
}

// Takes ten bits of one hash per channel: independent, each uniform in [-1, 1].
Rgb lattice_value(int x, int y, int z, std::uint32_t seed) {
  const std::uint32_t h =
      scramble(static_cast<std::uint32_t>(x) * 0x9e3779b1U + static_cast<std::uint32_t>(y) * 0x85ebca77U +
               static_cast<std::uint32_t>(z) * 0xc2b2ae3dU + seed);
  const auto channel = [h](int shift) { return static_cast<float>((h >> shift) & 1023U) * (2.0F / 1023.0F) - 1.0F; };
  return {{channel(0), channel(10), channel(20), 0.0F}};
}

float smooth(float t) { return t * t * (3.0F - 2.0F * t); }

// Value noise of one octave along a walk. The last point's cell is cached, since neighbours mostly share the cell.
class OctaveWalk {
 public:
  OctaveWalk(const glm::mat3& lattice_from_unit, float amplitude, std::uint32_t seed)
      : lattice_from_unit_(lattice_from_unit), amplitude_(amplitude), seed_(seed) {}

  void add_at(const glm::vec3& unit, Rgb& sum) {
    const glm::vec3 p = lattice_from_unit_ * unit;
    const glm::vec3 floor_p(std::floor(p.x), std::floor(p.y), std::floor(p.z));
    enter(static_cast<int>(floor_p.x), static_cast<int>(floor_p.y), static_cast<int>(floor_p.z));
    const float tx = smooth(p.x - floor_p.x);
    const float ty = smooth(p.y - floor_p.y);
    const float tz = smooth(p.z - floor_p.z);
    const Rgb low = mix(mix(corner_[0], corner_[1], tx), mix(corner_[2], corner_[3], tx), ty);
    const Rgb high = mix(mix(corner_[4], corner_[5], tx), mix(corner_[6], corner_[7], tx), ty);
    const Rgb value = mix(low, high, tz);
    for (std::size_t i = 0; i < 4; ++i) sum.c[i] += amplitude_ * value.c[i];
  }

 private:
  void enter(int x, int y, int z) {
    if (filled_ && x == x_ && y == y_ && z == z_) return;
    x_ = x;
    y_ = y;
    z_ = z;
    filled_ = true;
    for (int i = 0; i < 8; ++i) {
      corner_[static_cast<std::size_t>(i)] = lattice_value(x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2), seed_);
    }
  }

  glm::mat3 lattice_from_unit_;
  float amplitude_;
  std::uint32_t seed_;
  bool filled_ = false;
  int x_ = 0, y_ = 0, z_ = 0;
  std::array<Rgb, 8> corner_{};
};

// Rotates each octave's lattice differently; an axis-aligned lattice would favour the pole and the equator.
std::vector<OctaveWalk> make_octaves(const NoisePlanetOptions& options) {
  std::mt19937 engine(options.seed);
  const auto uniform = [&engine] { return static_cast<float>(engine()) * 0x1p-31F - 1.0F; };
  const double texels_per_radian = options.width / (2.0 * std::numbers::pi);
  std::vector<OctaveWalk> walks;
  for (const Octave& octave : kOctaves) {
    glm::quat turn(1.0F, 0.0F, 0.0F, 0.0F);
    do {
      // Separate statements, because the compiler chooses the evaluation order of a call's arguments.
      turn.z = uniform();
      turn.y = uniform();
      turn.x = uniform();
      turn.w = uniform();
    } while (glm::length(turn) > 1.0F || glm::length(turn) < 0.1F);
    const float cells_per_radian = static_cast<float>(texels_per_radian / octave.spacing_texels);
    walks.emplace_back(cells_per_radian * glm::mat3_cast(glm::normalize(turn)), octave.amplitude_levels,
                       static_cast<std::uint32_t>(engine()));
  }
  return walks;
}

void fill_rows(Picture& picture, std::vector<OctaveWalk> octaves, const std::vector<glm::vec2>& meridian, int first,
               int last) {
  for (int y = first; y < last; ++y) {
    const double lat = std::numbers::pi * (0.5 - (y + 0.5) / picture.height);
    const float z = static_cast<float>(std::sin(lat));
    const float r = static_cast<float>(std::cos(lat));
    std::uint8_t* out = picture.rgb.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width);
    for (const glm::vec2& m : meridian) {
      Rgb sum{{kMeanLevel, kMeanLevel, kMeanLevel, 0.0F}};
      for (OctaveWalk& octave : octaves) octave.add_at({r * m.x, r * m.y, z}, sum);
      for (std::size_t i = 0; i < 3; ++i) *out++ = static_cast<std::uint8_t>(std::clamp(sum.c[i], 0.0F, 255.0F) + 0.5F);
    }
  }
}

}  // namespace

Picture noise_planet(const NoisePlanetOptions& options) {
  Picture picture{options.width, options.height, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
  const std::vector<OctaveWalk> octaves = make_octaves(options);
  std::vector<glm::vec2> meridian;
  for (int x = 0; x < options.width; ++x) {
    const double lon = 2.0 * std::numbers::pi * ((x + 0.5) / options.width - 0.5);
    meridian.emplace_back(static_cast<float>(std::cos(lon)), static_cast<float>(std::sin(lon)));
  }
  std::vector<std::jthread> workers;
  for (int i = 0; i < options.threads; ++i) {
    const int first = options.height * i / options.threads;
    const int last = options.height * (i + 1) / options.threads;
    workers.emplace_back([&, first, last] { fill_rows(picture, octaves, meridian, first, last); });
  }
  workers.clear();
  return picture;
}

}  // namespace terrella::truth
