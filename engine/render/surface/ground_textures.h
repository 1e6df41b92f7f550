#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "objects/ground/ground_picture.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// GroundFrame::cells has 16 bits for a slot.
inline constexpr int kMostGroundSlots = 0xFFFF;

/// GroundFrame::windows, z, of a patch on which lines of different colours cross.
inline constexpr unsigned kCrossedLines = 4;

/// Slots of a picture of the ground; -1: it has no such part.
struct GroundSlots {
  int fill = -1, line = -1;
  [[nodiscard]] bool any() const { return fill >= 0 || line >= 0; }
};

/// The pictures of what lies on the ground, in the slots of two array textures. Each texture grows up to capacity().
/// thread: main
class GroundTextures {
 public:
  explicit GroundTextures(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  /// Puts a picture into slots, into those of `slots` if it has them. False if there is no room; the slots that it got
  /// are then in `slots`.
  bool put(const GroundPicture& picture, GroundSlots& slots);
  void release(GroundSlots& slots);
  /// Sets the budget, and asks the driver again for memory that it has refused. False if the textures were too large:
  /// all pictures are gone then.
  [[nodiscard]] bool set_budget(std::size_t bytes);

  [[nodiscard]] std::size_t bytes() const;
  /// Pictures with both parts that fit in the budget, and on the GPU.
  [[nodiscard]] int capacity() const;
  [[nodiscard]] bool memory_refused() const { return most_slots_ < kMostGroundSlots; }  ///< since set_budget()
  /// Binds the textures to two units.
  void bind(GLuint fill_unit, GLuint line_unit) const;

 private:
  struct Plane {
    gl::Texture texture;
    int slots = 0, used = 0;
    std::vector<int> free;
  };
  enum { fill, line };
  [[nodiscard]] gl::Texture make(int plane, int slots) const;
  bool grow(int plane);
  void give_back(int plane, int& slot);
  bool take(int plane, int& slot);

  std::size_t budget_bytes_;
  int most_slots_ = kMostGroundSlots;
  std::array<Plane, 2> planes_;
  gl::Sampler fill_sampler_, line_sampler_;
};

/// The pictures on the patches of a frame.
struct GroundFrame {
  const GroundTextures* textures = nullptr;
  /// Per patch of the base layer: first of its cells; log2 of its cells a side; 1: has areas, 2: has lines, 4: is
  /// seen at a slant; 4 alone: all these, and lines of different colours cross. 0: nothing lies on the patch.
  std::vector<glm::uvec4> windows;
  /// Rows of cells from the south-west. Slots of areas and of lines (16 bits each, 0xFFFF: none); then how many times
  /// the picture's square is halved to get the cell (4 bits), the cell's column and row among these parts (12 bits
  /// each), and log2 of the reach of lines, less 2.
  std::vector<glm::uvec2> cells;
  [[nodiscard]] bool empty() const { return cells.empty(); }
};

}  // namespace terrella
