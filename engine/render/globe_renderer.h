#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
#include "render/gl/frame_block.h"
#include "render/gl/frame_targets.h"
#include "render/gl/gl_handle.h"
#include "render/objects/object_pass.h"
#include "render/sky/sky_pass.h"
#include "render/surface/inner_sphere_pass.h"
#include "render/surface/interlace_pass.h"
#include "render/surface/limb_pass.h"
#include "render/surface/night_lights.h"
#include "render/surface/outline_pass.h"
#include "render/surface/patch_pass.h"
#include "render/surface/tile_textures.h"
#include "surface/layers.h"
#include "surface/plan/patch_selection.h"
#include "surface/plan/tile_coverage.h"
#include "surface/relief.h"
#include "view/render_modes.h"
#include "view/stereo.h"

namespace terrella {

/// An image layer in a frame. Draws belong to patches, one to one.
struct LayerFrame {
  const PatchTree* tree = nullptr;
  const std::vector<SelectedPatch>* patches = nullptr;
  const TileCoverage* coverage = nullptr;
  const TileTextures* tiles = nullptr;
  PatchLayer* gpu = nullptr;
  double opacity = 1.0;
  Daylight daylight = Daylight::both;
  AlphaFrom alpha = AlphaFrom::own;
  [[nodiscard]] bool is_special() const { return daylight != Daylight::both || alpha != AlphaFrom::own; }
};

/// Input of one frame.
struct FrameInput {
  Viewport size;
  glm::ivec2 corner_px{0};         ///< of the picture in the framebuffer, lower left
  View view;                       ///< of the one eye
  std::optional<EyePair> eyes;     ///< of two; then `view` is not used
  Stereo stereo = Stereo::off;     ///< how the pictures of two eyes are put together
  std::vector<LayerFrame> layers;  ///< the lowest first: it is opaque and has every patch; the others lie over it
  const Relief* relief = nullptr;  ///< of the patches, if they were raised
  SurfaceLook surface;
  std::optional<SkyInput> sky;  ///< none: black
  bool lit = true;
  glm::dvec3 sun{1.0, 0.0, 0.0};  ///< unit, ECEF axes
  std::uint64_t frame = 0;
  double ground_m = 0.0;  ///< height of the ground under the eye
  /// For tests: an opaque globe's order with blending switched on, to show what paper 2 prevents.
  bool naive_translucency = false;
};

/// Data of the sky. Programs for the sky exist only if the data is given.
struct SkyAssets {
  Body body;
  std::vector<Star> stars;
  GreyPicture night_lights;  ///< empty: no day and night on the surface
};

/// Draws frames: the list of passes, and the state that each of them draws with. thread: main (of the context)
class GlobeRenderer {
 public:
  [[nodiscard]] static Result<std::unique_ptr<GlobeRenderer>> create(const RenderOptions& options,
                                                                     const Ellipsoid& ellipsoid, const SkyAssets* sky);
  /// Whether patches have relief from now on; to be said before the first frame. The layers' vertices are to be made
  /// anew.
  Status set_relief(bool on);
  /// By the names that contexts do not share.
  [[nodiscard]] bool is_of_current_context() const { return patches_->is_of_current_context(); }

  /// A font file's bytes, before the first objects; without one there are no labels.
  void set_label_font(std::vector<std::byte> font) { label_font_ = std::move(font); }
  /// In place of those before; the program for objects is made with the first.
  Status set_objects(std::span<const CutScene> scenes);

  /// Draws the picture of one eye, or of both, into `framebuffer`. Uploads once what the eyes share. Makes the programs
  /// that no frame before has needed; if one of them cannot be made, returns the error and draws nothing.
  Result<FrameCounts> draw(const FrameInput& input, GLuint framebuffer);

 private:
  /// One eye's part of the picture.
  struct EyePicture {
    View view;
    int left_px = 0;
    bool red = true, green = true, blue = true;
    bool interlaced = false;
    GLuint row_bits = 0;  ///< interlaced: the stencil of its rows
  };
  /// Bits of stencil_bits.h: a draw passes where some are clear and some set, and sets others there.
  struct Marks {
    GLuint clear = 0, needed = 0, set = 0;
  };
  /// Passes that draw the surface once more, after its depth is there.
  static constexpr DepthState kSameDepth{.test = GL_EQUAL, .write = false};
  /// Values that all passes of one picture share.
  struct Pass {
    const FrameInput& input;
    const EyePicture& eye;
    FrameCounts& counts;
    [[nodiscard]] const LayerFrame& first() const { return input.layers.front(); }
    [[nodiscard]] std::span<const LayerFrame> further() const { return std::span(input.layers).subspan(1); }
  };

  GlobeRenderer(const RenderOptions& options, const Ellipsoid& ellipsoid) : options_(options), ellipsoid_(ellipsoid) {}
  [[nodiscard]] static std::vector<EyePicture> pictures_of(const FrameInput& input);
  Status prepare(const Pass& pass);
  void draw_picture(const Pass& pass);
  void draw_from_above(const Pass& pass);
  void draw_from_below(const Pass& pass);
  void draw_naively(const Pass& pass);
  void draw_inner_sphere(const Pass& pass);
  void draw_far_side_curtain(const Pass& pass);
  [[nodiscard]] bool has_inner_sphere(const Pass& pass) const;
  [[nodiscard]] SurfaceFromBelow surface_look(const Pass& pass) const;
  void draw_surface(const Pass& pass) const;
  [[nodiscard]] static PatchBuffers& vertices_of(const LayerFrame& layer, const LayerFrame& first);
  void upload_layers(const FrameInput& input) const;
  void draw_first(const Pass& pass, const DrawState& state) const;
  void draw_further(const Pass& pass, const LayerFrame& layer, const DrawState& state) const;
  void draw_layers(const Pass& pass, SurfaceFromBelow look, DrawState state) const;
  void draw_layers_translucent(const Pass& pass, DrawState state) const;
  [[nodiscard]] static BlendState surface_blend(const SurfaceLook& look);
  void draw_sky(const Pass& pass);
  void draw_objects(const Pass& pass, ObjectPart part, ObjectChoice choice, GLuint mark);
  void draw_limb(const Pass& pass, bool in_place);
  [[nodiscard]] bool mountains_on_limb(const Pass& pass) const;
  void begin_frame(const FrameInput& input, FrameCounts& counts);
  void begin_picture(const Pass& pass) const;
  /// The state that passes of a picture begin with: the nearer front faces win, in the eye's colors and rows.
  [[nodiscard]] DrawState picture_state(const EyePicture& eye) const;
  [[nodiscard]] std::optional<StencilState> stencil(const EyePicture& eye, const Marks& marks) const;
  enum class DepthTest { nearer, nearer_or_equal };
  [[nodiscard]] DepthState depth(DepthTest test) const;
  void upload_frame(const Pass& pass);
  void upload_frame(const LayerFrame& layer) const;
  void describe_layer(const LayerFrame& layer, FrameBlock& block) const;
  [[nodiscard]] double near_m(const Pass& pass) const;
  [[nodiscard]] LabelSight label_sight(const Pass& pass) const;
  [[nodiscard]] bool limb_comes_last(const Pass& pass) const;
  [[nodiscard]] bool under_ground(const Pass& pass) const;
  [[nodiscard]] double hiding_radius_m(const Pass& pass) const;
  [[nodiscard]] double inner_radius_m(const FrameInput& input) const;

  RenderOptions options_;
  Ellipsoid ellipsoid_;
  std::unique_ptr<PatchPass> patches_;
  std::unique_ptr<LimbPass> limb_;
  std::unique_ptr<OutlinePass> outline_;
  std::unique_ptr<InnerSpherePass> inner_sphere_;
  std::unique_ptr<InterlacePass> interlace_;
  std::unique_ptr<SkyPass> sky_;
  std::optional<NightLights> night_lights_;
  std::unique_ptr<ObjectPass> objects_;
  std::vector<std::byte> label_font_;
  FrameTargets targets_;
  FrameBlock frame_{};  ///< of the eye whose picture is drawn
  gl::Buffer frame_block_;
};

}  // namespace terrella
