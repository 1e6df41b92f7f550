#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "geo/camera.h"
#include "scene/object_batches.h"

namespace terrella {

/// What small spheres are drawn by, as shaders/frame.glsl has it.
struct SplatView {
  glm::mat3 view_from_ecef;
  glm::vec3 eye_high_ecef;
  glm::vec3 eye_low_ecef;
  glm::vec2 focal;  ///< clip_scale's x and y
  glm::vec3 sun_ecef;
  bool lit = true;
  Viewport viewport;
  double hiding_radius_m = 0.0;  ///< as ObjectPass::draw() has it
};

/// A square of the picture, row by row from the bottom: the nearest sphere at each pixel.
inline constexpr int kSplatBlock_px = 32;
struct SplatBlock {
  static constexpr std::size_t kPixels = std::size_t{kSplatBlock_px} * kSplatBlock_px;
  std::array<std::uint32_t, kPixels> rgba{};  ///< red in the low byte, alpha how much of the pixel is covered; 0: none
  std::array<float, kPixels> nearness{};      ///< 1 over its distance before the eye's plane, metres
};

/// Spheres in the order of a curve through space, within each bucket of their batch, and a ball around each few of
/// them: those that lie together are left out together, and touch the same part of the picture. thread: any
class SphereGroups {
 public:
  static constexpr std::size_t kSize = 64;
  struct Ball {
    glm::vec3 high_m, low_m;
    float radius_m;
  };

  SphereGroups() = default;
  explicit SphereGroups(const Batch<DotInstance>& batch);
  [[nodiscard]] const std::vector<DotInstance>& items() const { return items_; }
  [[nodiscard]] const std::vector<Ball>& balls() const { return balls_; }  ///< of items k · kSize and those after it

 private:
  std::vector<DotInstance> items_;
  std::vector<Ball> balls_;
};

/// Draws spheres that are few pixels wide into a picture in memory: on software GL a triangle costs a microsecond,
/// which a hundred thousand of them would pay each. Same look as shaders/object_sphere: its formulas, with the
/// outline's perspective linear around the centre (less than 0.1 pixels off at the widest, kMostRadius_px). thread:
/// any, one
class SphereSplats {
 public:
  static constexpr float kMostRadius_px = 8.0F;  ///< wider ones are left to triangles

  /// Draws a range of spheres, those that can be seen, into an empty picture.
  void draw(const SphereGroups& spheres, std::size_t first, std::size_t count, const SplatView& view);

  /// The blocks of the picture that hold anything, and where they are: column + 65536 × row, rows from the bottom.
  [[nodiscard]] std::span<const SplatBlock> blocks() const { return blocks_; }
  [[nodiscard]] std::span<const std::uint32_t> places() const { return places_; }
  /// What is too wide, or too near to the eye.
  [[nodiscard]] std::span<const DotInstance> large() const { return large_; }

 private:
  struct Disc;
  struct Lens;
  class Hiding;
  void begin(Viewport viewport);
  void add(const DotInstance& sphere, const Lens& lens, const Hiding& hiding);
  void add(const Disc& disc, const SplatView& view);
  void add_to_block(const Disc& disc, int column, int row, bool lit);
  template <bool lit>
  static void add_to_lanes(const Disc& disc, const glm::vec2& off, float* nearness, std::uint32_t* rgba);
  [[nodiscard]] SplatBlock& block_at(int column, int row);

  int columns_ = 0;
  std::vector<std::int32_t> slots_;  ///< of each block of the picture; -1: not touched
  std::vector<std::uint32_t> places_;
  std::vector<SplatBlock> blocks_;
  std::vector<DotInstance> large_;
};

}  // namespace terrella
