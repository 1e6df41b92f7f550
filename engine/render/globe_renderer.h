#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "geo/camera.h"
#include "geo/result.h"
#include "render/frame_block.h"
#include "render/gl_handle.h"
#include "render/limb_pass.h"
#include "render/patch_buffers.h"
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
};

/// What one frame is drawn from.
struct FrameInput {
  View view;
  const std::vector<SelectedPatch>* patches = nullptr;
  const TileCoverage* coverage = nullptr;  ///< draws belong to patches, one to one
  bool lit = true;
  glm::dvec3 sun{1.0, 0.0, 0.0};  ///< unit, ECEF axes
  std::uint64_t frame = 0;
};

struct FrameCounts {
  int draw_calls = 0;
  long triangles = 0;
};

/// Draws patches. Owns programs, vertex places and the picture that the passes draw into before it goes to the target.
/// thread: main (of the context)
class GlobeRenderer {
 public:
  [[nodiscard]] static Result<std::unique_ptr<GlobeRenderer>> create(const RenderOptions& options, PatchTree& tree);

  /// The passes of a frame, in order: clear, patches program by program, copy to `framebuffer`, limb.
  FrameCounts draw(const FrameInput& input, TileTextures& tiles, const SlotLayout& layout, GLuint framebuffer);

 private:
  /// Programs in the order they are drawn.
  enum PatchProgram { magnified, plain, oblique, polar, paper, kPatchPrograms };

  GlobeRenderer(const RenderOptions& options, PatchTree& tree) : options_(options), tree_(tree), patches_(tree) {}
  Status build_programs();
  void set_up_vertex_array();
  void set_up_samplers();
  void resize(Viewport viewport);
  void upload_frame(const FrameInput& input, const SlotLayout& layout, int mips);
  void upload_draws(const FrameInput& input, FrameCounts& counts);
  void bind_state(const FrameInput& input, TileTextures& tiles) const;
  void draw_patches(FrameCounts& counts) const;
  [[nodiscard]] PatchProgram program_for(const SelectedPatch& patch) const;

  RenderOptions options_;
  PatchTree& tree_;
  PatchBuffers patches_;
  std::unique_ptr<LimbPass> limb_;
  gl::Program programs_[kPatchPrograms];
  gl::VertexArray vertex_array_;
  gl::Buffer frame_block_, draws_, commands_, cells_;
  gl::Texture cells_texture_;
  gl::Sampler bilinear_, precise_, mipmapped_;
  gl::Texture color_, depth_;
  gl::Framebuffer framebuffer_;
  Viewport size_{0, 0};
  int first_command_[kPatchPrograms + 1] = {};
};

}  // namespace terrella
