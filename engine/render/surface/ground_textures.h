#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "objects/ground/ground_picture.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// GroundFrame::cells has 16 bits for a slot.
inline constexpr int kMostGroundSlots = 0xFFFF;

/// GroundFrame::windows, z, of a patch with lines below others or with casings.
inline constexpr unsigned kMoreLines = 4;

/// Slots of a picture of the ground, of its areas and of its sheets of lines; -1: it has no such part.
struct GroundSlots {
  int fill = -1;
  std::array<int, GroundPicture::kSheets> lines{-1, -1, -1};
  [[nodiscard]] bool any() const { return fill >= 0 || lines != std::array{-1, -1, -1}; }
  [[nodiscard]] bool has_more_lines() const {
    return lines[GroundPicture::below] >= 0 || lines[GroundPicture::casing] >= 0;
  }
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
  /// Pictures that fit in the budget and on the GPU, if all have the most parts that one has had since set_budget().
  [[nodiscard]] int capacity() const;
  /// Counts the parts of a picture for capacity(). False if the textures were too large: all pictures are gone then.
  [[nodiscard]] bool admit(const GroundPicture& picture);
  [[nodiscard]] bool memory_refused() const { return most_pictures_ < kMostGroundSlots; }  ///< since set_budget()
  /// Binds the textures to two units.
  void bind(GLuint fill_unit, GLuint line_unit) const;

 private:
  struct Plane {
    gl::Texture texture;
    int slots = 0, used = 0;
    int parts = 0;  ///< most slots of a picture since set_budget()
    std::vector<int> free;
  };
  enum { fill, line };
  [[nodiscard]] gl::Texture make(int plane, int slots) const;
  bool grow(int plane);
  void give_back(int plane, int& slot);
  bool take(int plane, int& slot);
  bool provide(int plane, bool wanted, int& slot);
  [[nodiscard]] int most_slots(int plane) const { return capacity() * planes_[static_cast<std::size_t>(plane)].parts; }
  [[nodiscard]] bool keep_within_budget();

  std::size_t budget_bytes_;
  int most_pictures_ = kMostGroundSlots;
  std::array<Plane, 2> planes_;
  gl::Sampler fill_sampler_, line_sampler_;
};

/// The pictures on the patches of a frame.
struct GroundFrame {
  const GroundTextures* textures = nullptr;
  /// Per patch of the base layer: first of its cells; log2 of its cells a side; 1: has areas, 2: has lines, 4: is
  /// seen at a slant; 4 alone: all these, and lines below others or casings. 0: nothing lies on the patch.
  std::vector<glm::uvec4> windows;
  /// Rows of cells from the south-west. Slots of areas and of lines on top (16 bits each, 0xFFFF: none); then how many
  /// times the picture's square is halved to get the cell (4 bits), the cell's column and row among these parts (12
  /// bits each), and log2 of the reach of lines, less 2; then slots of lines below and of casings.
  std::vector<glm::uvec3> cells;
  [[nodiscard]] bool empty() const { return cells.empty(); }
};

}  // namespace terrella
