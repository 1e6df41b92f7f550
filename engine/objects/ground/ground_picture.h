#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "objects/ground/ground_batch.h"

// Pictures of what lies on a square of the ground. thread: any
namespace terrella {

/// A square of a face, in face coordinates.
struct FaceSquare {
  CubeFace face = CubeFace::pos_x;
  double west = -1.0, south = -1.0, side = 2.0;
};

/// One line for each texel: its colour, RGBA8; and half its width in 1/8 px (9 bits), whether its nearest point is an
/// end of a piece (1 bit), its distance from the texel's middle (10 bits, 512 + 511 · distance / reach) along a
/// direction of a half turn (x: 6 bits, 32 + 31 · x; y: 6 bits, 63 · y). 0: no line is within reach.
using LineSheet = std::vector<glm::uvec2>;

/// The texels of a picture: rows from the south. A square fills the middle; around it is a rim of neighbours' texels.
struct GroundPicture {
  static constexpr int kSide_px = 256, kRim_px = 4, kInner_px = kSide_px - 2 * kRim_px;
  static constexpr int kMips = 5;
  static constexpr float kLeastReach_px = 4.0F, kMostReach_px = 64.0F;

  /// Colours of areas, premultiplied, RGBA8: all mips, finest first. Empty: no area is there.
  std::vector<std::uint32_t> fill;
  /// Lines: those that lie on top, those that show below them where they cross, and casings below both. An empty sheet
  /// has none.
  enum { top, below, casing, kSheets };
  std::array<LineSheet, kSheets> lines;
  float reach_px = kLeastReach_px;  ///< most texels between a line and its texels
};

/// Objects of one layer that may lie on a square.
using GroundChunks = std::vector<std::shared_ptr<const GroundChunk>>;

/// Returns the part of a face that a square's picture shows, with texels up to `reach_px` around it.
[[nodiscard]] FaceBox box_of(const FaceSquare& square, double reach_px);

/// Memory for the work of paint_ground(), used again by the next call: fresh memory takes as long as the work.
/// thread: any, but one call at a time
class GroundCanvas {
 public:
  GroundCanvas();
  ~GroundCanvas();
  struct Memory;
  [[nodiscard]] Memory& memory();
  void forget();  ///< frees the memory. Call it after an exception of paint_ground()

 private:
  std::unique_ptr<Memory> memory_;
};

/// Paints a picture. `layers`: the lowest first. `stretch`: pixels are at most that many texels long. Areas that share
/// an edge share no sample and leave none out. Ends early, with a useless result, once `stop` is set.
[[nodiscard]] GroundPicture paint_ground(const FaceSquare& square, std::span<const GroundChunks> layers, double stretch,
                                         const std::atomic<bool>& stop, GroundCanvas& canvas);

}  // namespace terrella
