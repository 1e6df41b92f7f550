#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "geo/body.h"
#include "geo/camera.h"
#include "render/gl/gl_handle.h"
#include "render/gl/shader_functions.h"
#include "surface/patch_mesh.h"
#include "surface/plan/patch_selection.h"
#include "surface/plan/tile_coverage.h"

namespace terrella::bench {

/// The engine's patches for a view without tiles, with their vertices and shader values.
struct PatchScene {
  PatchTree tree;
  View view;
  std::vector<SelectedPatch> patches;
  std::vector<PatchVertex> vertices;  ///< vertices of all patches in sequence

  /// Selects patches as the engine does; `max_level` is the finest tile level.
  PatchScene(const Camera& camera, Viewport size, int max_level, const Body& body = earth());
  [[nodiscard]] std::size_t vertices_per_patch() const;
  /// ECEF position of a patch's vertex, as exact as its two floats.
  [[nodiscard]] glm::dvec3 position_m(std::size_t vertex) const;
};

/// A pixel's window point by both ways of texturing, and its patch.
struct WindowPixel {
  glm::vec4 points;    ///< interpolated; exact
  unsigned patch = 0;  ///< number of the patch from 1; 0: no patch at this pixel
};

/// Runs the engine's own vertex program on a scene's patches. thread: main (of the context)
class PatchProbe {
 public:
  [[nodiscard]] static Result<PatchProbe> create(ShaderFunctions functions);

  /// Uploads the scene's patches to the GPU; `scene` must stay.
  void load(PatchScene& scene);
  /// Computes gl_Position of every vertex by the program for an eye.
  [[nodiscard]] std::vector<glm::vec4> positions(const View& view);
  /// Returns every pixel of the scene's view, rows from the bottom.
  [[nodiscard]] std::vector<WindowPixel> window_pixels();

 private:
  PatchProbe() = default;
  void upload_frame(const View& view);
  void set_patch(std::size_t patch) const;
  void draw_patches();

  PatchScene* scene_ = nullptr;
  gl::Program feedback_program_, window_program_;
  gl::VertexArray array_;
  gl::Buffer vertices_, indices_, frame_, feedback_;
  gl::Texture pixel_;  ///< dummy target: a context without a window has no framebuffer of its own
  gl::Framebuffer somewhere_;
  PatchIndices triangles_;
  std::vector<PatchDraw> draws_;
};

}  // namespace terrella::bench
