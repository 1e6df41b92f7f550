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
#include "scene/splat_kernel.h"

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

/// A part of the picture, row by row from the bottom: the nearest sphere at each pixel.
struct SplatBlock {
  static constexpr std::size_t kPixels = std::size_t{kSplatBlockWidth_px} * kSplatBlockHeight_px;
  std::array<std::uint32_t, kPixels> rgba;  ///< red in the low byte, alpha how much of the pixel is covered
  std::array<float, kPixels> nearness;      ///< 1 over its distance before the eye's plane, metres; 0: no sphere
};

/// Spheres in the order of a curve through space, within each bucket of their batch, and a ball around each few of
/// them: those that lie together are left out together, and touch the same part of the picture. thread: any
class SphereGroups {
 public:
  struct Ball {
    glm::vec3 high_m, low_m;
    float radius_m;
  };
  struct Group {
    std::size_t first;  ///< of items()
    int count;
    Ball ball;
    SplatSpheres spheres;
  };

  SphereGroups() = default;
  explicit SphereGroups(const Batch<DotInstance>& batch);
  [[nodiscard]] const std::vector<DotInstance>& items() const { return items_; }
  [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }  ///< of items that follow each other

 private:
  std::vector<DotInstance> items_;
  std::vector<Group> groups_;
};

/// Draws spheres that are few pixels wide into a picture in memory: on software GL a triangle costs a microsecond,
/// which a hundred thousand of them would pay each. Same look as shaders/object_sphere: its formulas, with the
/// outline's perspective linear around the centre (less than 0.1 pixels off at the widest, kMostRadius_px). The
/// picture's rows are shared out among as many threads as there are processors; the pixels are the same with any
/// number. thread: any, one
class SphereSplats {
 public:
  static constexpr float kMostRadius_px = 8.0F;  ///< wider ones are left to triangles

  SphereSplats();

  /// Blocks that a picture has: row by row from the lower left corner.
  [[nodiscard]] static std::size_t blocks_of(Viewport viewport);
  /// Draws a range of spheres, some of their batch's buckets, those that can be seen, into an empty picture of
  /// blocks_of(view.viewport) blocks. Blocks that no sphere touches are left as they are.
  void draw(const SphereGroups& spheres, std::size_t first, std::size_t count, const SplatView& view,
            std::span<SplatBlock> picture);

  /// Blocks side by side that hold anything.
  struct Run {
    std::uint32_t column, row, blocks;  ///< of the first, counted from the lower left corner; how many
    std::uint32_t first_block;          ///< of the picture
  };
  [[nodiscard]] std::vector<Run> runs() const;
  /// What is too wide, or too near to the eye.
  [[nodiscard]] std::span<const DotInstance> large() const { return large_; }

 private:
  class Band;
  struct Code {
    decltype(&place_splats) place;
    decltype(&draw_splat) draw;
  };
  Code code_{place_splats, draw_splat};  ///< for this processor
  int columns_ = 0;
  std::vector<std::uint8_t> touched_;  ///< block by block
  std::vector<DotInstance> large_;
};

}  // namespace terrella
