#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "geo/camera.h"
#include "geo/result.h"
#include "render/gl_handle.h"
#include "render/patch_buffers.h"
#include "render/shader_functions.h"
#include "render/tile_textures.h"
#include "scene/patch_selection.h"
#include "scene/render_modes.h"
#include "scene/tile_coverage.h"

namespace terrella {

/// What fixes the programs; another choice is another renderer.
struct RenderOptions {
  Texturing texturing = Texturing::automatic;
  DepthMode depth = DepthMode::reversed;
  double paper_a = 4.0;
  double paper_band = 0.05;
  bool night_lights = false;                      ///< the surface by day and night; the caller binds NightLights
  std::optional<ShaderFunctions> functions = {};  ///< none: the driver's, if they are good enough
};

struct FrameCounts {
  int draw_calls = 0;
  long triangles = 0;
};

/// Draws the surface's patches. Owns their programs and their places in memory. The caller has bound the framebuffer
/// and the frame's uniform block and has set depth, stencil, blending and which faces are culled. thread: main (of the
/// context)
class PatchPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<PatchPass>> create(const RenderOptions& options, PatchTree& tree);

  /// Once a frame, for both eyes. `coverage` belongs to `patches`, one to one.
  void upload(const std::vector<SelectedPatch>& patches, const TileCoverage& coverage, std::uint64_t frame);
  /// Program by program.
  void draw(const TileTextures& tiles, FrameCounts& counts) const;
  /// Depth alone, in one call; the depths are the bits that draw() makes.
  void draw_depth(FrameCounts& counts) const;

 private:
  /// Programs in the order they are drawn.
  enum PatchProgram { magnified, plain, oblique, polar, paper, kPatchPrograms };

  PatchPass(const RenderOptions& options, PatchTree& tree)
      : options_(options), has_relief_(tree.relief() != nullptr), patches_(tree) {}
  Status build_programs();
  [[nodiscard]] Result<gl::Program> patch_program(std::initializer_list<std::string_view> fragment) const;
  void set_up_vertex_array();
  void set_up_samplers();
  void bind_vertices() const;
  void draw_commands(int first, int last, FrameCounts& counts) const;
  [[nodiscard]] PatchProgram program_for(const SelectedPatch& patch) const;

  RenderOptions options_;
  bool has_relief_;
  PatchBuffers patches_;
  gl::Program programs_[kPatchPrograms];
  gl::Program depth_program_;
  gl::VertexArray vertex_array_;
  gl::Buffer draws_, commands_, cells_;
  gl::Texture cells_texture_;
  gl::Sampler bilinear_, precise_, mipmapped_;
  int first_command_[kPatchPrograms + 1] = {};
  long triangles_ = 0;
};

}  // namespace terrella
