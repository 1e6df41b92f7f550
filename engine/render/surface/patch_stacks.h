#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <tuple>
#include <vector>

#include "render/gl/gl_handle.h"
#include "render/surface/number_colors.h"
#include "render/surface/tile_textures.h"
#include "surface/plan/tile_coverage.h"
#include "surface/selected_patch.h"

namespace terrella {

/// An image layer as stacks need it.
struct StackLayer {
  const std::vector<SelectedPatch>* patches = nullptr;
  const TileCoverage* coverage = nullptr;  ///< its draws and `patches` correspond one to one
  const TileTextures* tiles = nullptr;
  const NumberColors* numbers = nullptr;  ///< null: a layer of pictures
  glm::vec4 texels{};                     ///< FrameBlock::texels
  float opacity = 1.0F;
  glm::vec4 look{0.0F};  ///< FrameBlock::layer_look
  glm::vec4 tone{0.0F};  ///< FrameBlock::layer_tone
  bool special = false;  ///< LayerFrame::special
  bool hides = false;    ///< hides all layers under it wherever it has tiles
};

/// The patches of a frame on which one pass draws several image layers, or a layer and what lies on the ground. A layer
/// without tiles on a patch, or under a layer that hides it there, takes no part. PatchPass plans, uploads and draws.
/// thread: main
struct PatchStacks {
  /// Most layers of one pass: their tiles and colours have 8 of OpenGL ES 3.0's 16 texture units, and their windows the
  /// vertex attributes that are left. Relief leaves room for one less.
  static constexpr int kMost = 4, kMostWithRelief = 3;
  /// Texture units of the layers' tiles, and of the colours of numbers.
  static constexpr std::array<GLuint, kMost> kTileUnits{3, 11, 12, 13}, kColorUnits{NumberColors::kUnit, 5, 14, 15};
  using Layers = std::array<std::uint16_t, kMost>;
  /// One pass over one patch.
  struct Group {
    int pass = 0;        ///< the order of drawing; pass 0 writes depth, later ones are blended over it
    bool whole = false;  ///< false: its triangles at the limb, which come first: they lie before the ground that whole
                         ///< patches have there
    std::uint32_t program = 0;                  ///< StackProgram::key()
    Layers layers{};                            ///< the lowest first; those after the program's number are 0
    std::uint32_t patch = 0;                    ///< patch of the base layer
    std::array<std::uint32_t, kMost> places{};  ///< its number among the patches of each layer
    [[nodiscard]] auto batch() const { return std::tie(pass, whole, program, layers); }
  };
  /// Draw commands with one state.
  struct Batch {
    Group first;
    int from = 0, to = 0;
  };
  std::vector<Group> groups;  ///< in the order of drawing
  /// By layer of the frame and patch of that layer: true if the layer's own programs draw the patch. A stack draws the
  /// others, or nothing of the layer shows there. Empty for a layer alone, which draws all.
  std::vector<std::vector<bool>> own;

  std::vector<Batch> batches;
  gl::Buffer windows, commands, cells, limb_indices;
  gl::Texture cells_texture;
  long triangles = 0;
};

/// The program of a stack, as a key.
struct StackProgram {
  struct Slot {
    std::uint8_t look = 0;  ///< PatchLayer::Program or PatchLayer::LimbProgram
    bool numbers = false, special = false;
  };
  bool base =
      true;  ///< the lowest layer is the base layer; false: an upper layer that hides all below, or a later pass
  bool night = false;   ///< with city lights
  unsigned ground = 0;  ///< objects on the ground are drawn too: GroundFrame::windows, z
  int count = 1;        ///< [1, PatchStacks::kMost]
  std::array<Slot, PatchStacks::kMost> slots{};
  [[nodiscard]] std::uint32_t key() const;
  [[nodiscard]] static StackProgram of_key(std::uint32_t key);
};

}  // namespace terrella
