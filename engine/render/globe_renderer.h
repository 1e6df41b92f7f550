#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/context_mark.h"
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
#include "render/surface/slope_textures.h"
#include "render/surface/tile_textures.h"
#include "surface/layers.h"
#include "surface/plan/patch_selection.h"
#include "surface/plan/tile_coverage.h"
#include "surface/relief.h"
#include "view/frame_matrices.h"
#include "view/render_modes.h"
#include "view/stereo.h"

namespace terrella {

// "Paper 1" is A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023. "Paper 2" is "Interactive visualization of 3D data on a virtual globe in stereoscopic
// systems", abstract of a dissertation, chapter 2.2 (engine/DESIGN.md).

/// An image layer in a frame. `patches` and the draws of `coverage` correspond one to one.
struct LayerFrame {
  const PatchTree* tree = nullptr;
  const std::vector<SelectedPatch>* patches = nullptr;
  const TileCoverage* coverage = nullptr;
  const TileTextures* tiles = nullptr;
  PatchLayer* gpu = nullptr;
  /// The layer's own vertices, which all views share; empty: those of the base layer.
  std::unique_ptr<PatchBuffers>* vertices = nullptr;
  double opacity = 1.0;
  Daylight daylight = Daylight::both;
  AlphaFrom alpha = AlphaFrom::own;
  SwipeSide swipe = SwipeSide::both;
  LayerBlend blend = LayerBlend::normal;  ///< normal for the base layer
  ImageTone tone{};
  bool unlit = false;     ///< neither lit nor seen through the air
  double height_m = 0.0;  ///< ImageLook::height_m
  /// The layer needs special programs: it shows on one side of a line, takes alpha from brightness, or has a height
  /// or a tone.
  bool special = false;
  bool hides = false;  ///< hides all layers under it wherever it has tiles
};

/// Input of one frame.
struct FrameInput {
  Viewport size;
  glm::ivec2 corner_px{0};              ///< lower left corner of the picture in the framebuffer
  View view;                            ///< view of the eye in a mono picture
  std::optional<EyePair> eyes;          ///< views of both eyes in stereo; `view` is then unused
  Stereo stereo = Stereo::off;          ///< way in which the pictures of two eyes are joined
  std::vector<LayerFrame> layers;       ///< the base layer, which is opaque and has every patch; then the upper layers
  const Relief* relief = nullptr;       ///< relief of the patches; null: the ellipsoid
  const GroundFrame* ground = nullptr;  ///< lines and areas on the ground; null: none
  PatchGround* ground_gpu = nullptr;    ///< the view's; not null if `ground` is not
  SurfaceLook surface;
  std::optional<SkyInput> sky;  ///< none: a black background
  bool lit = true;
  bool earth = false;             ///< has seas
  bool timed = false;             ///< the Sun is where a time puts it; false: over the viewer's shoulder
  glm::dvec3 sun{1.0, 0.0, 0.0};  ///< direction to the Sun: unit vector, ECEF axes
  std::uint64_t frame = 0;
  int views = 1;          ///< views that are drawn in turn
  double ground_m = 0.0;  ///< height of the ground under the eye
  /// Draws for the application; may be empty.
  const std::function<void(DrawStage, const FrameMatrices&)>* on_draw = nullptr;
  double paper_a = 4.0;      ///< a of paper 1's formula (6), for Texturing::paper
  double paper_band = 0.05;  ///< b of paper 1's formula (5), for Texturing::paper
  double pixel_scale = 1.0;  ///< pixels of the picture for each pixel of a size
  /// For tests: draws in the order of an opaque globe with blending switched on, to show the artefacts that paper 2
  /// prevents.
  bool naive_translucency = false;
  bool layers_one_by_one = false;  ///< for tests: no pass combines layers
};

/// The memory of one view from frame to frame.
struct PictureMemory {
  std::shared_ptr<FrameTargets> targets;  ///< views of equal form share them; null before the first frame
  GLuint framebuffer = 0;                 ///< the application's, as it was last checked
  std::uint64_t frame = 0;                ///< number of the last picture
  /// True if the targets still hold the view's last picture.
  [[nodiscard]] bool has_picture() const { return targets && frame != 0 && targets->frame() == frame; }
  std::unique_ptr<AirTextures> air;
  ShownLabels labels;
};

/// Data of the sky. The renderer makes programs for the sky only if it gets this data.
struct SkyAssets {
  Body body;
  std::vector<Star> stars;
  GreyPicture night_lights;  ///< empty: the surface has no night side
};

/// Draws frames. Holds the passes and decides in which order and with which state each of them draws. thread: main (of
/// the context)
class GlobeRenderer {
 public:
  [[nodiscard]] static Result<std::unique_ptr<GlobeRenderer>> create(const RenderOptions& options,
                                                                     const Ellipsoid& ellipsoid, const SkyAssets* sky);
  /// Draws patches with or without relief from now on. Call it before the first frame. Keeps the programs. The caller
  /// discards the vertices of all layers.
  void set_relief(bool on);
  /// Draws city lights on the night side from now on; an empty map: none.
  Status set_night_lights(const GreyPicture& map);
  [[nodiscard]] bool has_night_lights() const { return options_.night_lights; }
  /// Forgets the slopes on the GPU, because other heights will be drawn.
  void forget_slopes() { slopes_.reset(); }
  /// True if the current context is the one with this renderer's objects.
  [[nodiscard]] bool is_of_current_context() const { return context_.is_current(); }

  /// Sets the bytes of the font file for labels, before the first objects. Without a font there are no labels.
  void set_label_font(std::vector<std::byte> font) { label_font_ = std::move(font); }
  /// Sets the object layers to draw, the lowest first; they must stay until the next call. Makes the programs that the
  /// layers need.
  Status set_objects(std::vector<DrawnLayer> layers);

  /// Letters of labels that no font has, so far, in ascending order.
  [[nodiscard]] std::u32string without_font() const { return objects_ ? objects_->without_font() : std::u32string(); }

  /// Longest side of a picture that the driver draws, pixels.
  [[nodiscard]] int longest_side_px() const { return longest_side_px_; }
  /// Makes the programs of a frame that no earlier frame needed. Draws nothing.
  Status prepare(const FrameInput& input, PictureMemory& memory, GLuint framebuffer);
  /// Draws the picture of one eye, or of both, into `framebuffer`. Uploads the data that both eyes share once. Makes
  /// the programs that no earlier frame needed; if one cannot be made, returns the error and draws nothing.
  /// A multisampled framebuffer gets the samples of a picture with as many. `memory` is that of the view.
  Result<FrameCounts> draw(const FrameInput& input, PictureMemory& memory, GLuint framebuffer);
  /// Copies the depth of the targets' picture to each sample of a framebuffer: sample by sample if it has as many.
  Status copy_depth(const FrameTargets& from, GLuint framebuffer, glm::ivec2 corner_px);

 private:
  /// One eye's part of the picture.
  struct EyePicture {
    View view;
    int left_px = 0;
    bool red = true, green = true, blue = true;
    bool interlaced = false;
    GLuint row_bits = 0;  ///< stencil value of this eye's rows, if interlaced
  };
  /// Bits of stencil_bits.h for a draw. The draw passes where all `clear` bits are 0 and all `needed` bits are 1, and
  /// sets the `set` bits there.
  struct Marks {
    GLuint clear = 0, needed = 0, set = 0;
  };
  /// Depth state of passes that draw the surface again, over its own depth.
  static constexpr DepthState kSameDepth{.test = GL_EQUAL, .write = false};
  /// Values that all passes of one picture share.
  struct Pass {
    const FrameInput& input;
    const EyePicture& eye;
    FrameCounts& counts;
    [[nodiscard]] const LayerFrame& base() const { return input.layers.front(); }
    [[nodiscard]] std::span<const LayerFrame> upper() const { return std::span(input.layers).subspan(1); }
    [[nodiscard]] LayerRole role_of(const LayerFrame& layer) const {
      if (&layer == &base()) return LayerRole::base;
      if (layer.blend != LayerBlend::normal) return LayerRole::blended;
      return layer.special ? LayerRole::special : LayerRole::upper;
    }
  };

  GlobeRenderer(const RenderOptions& options, const Ellipsoid& ellipsoid) : options_(options), ellipsoid_(ellipsoid) {}
  void make_patches(RenderOptions options, bool relief);
  // globe_renderer.cpp: the order of the passes.
  Status prepare(const Pass& pass);
  [[nodiscard]] const AirTextures* air_of(const Pass& pass) const;
  void begin_frame(const FrameInput& input, FrameCounts& counts);
  void begin_picture(const Pass& pass) const;
  void draw_picture(const Pass& pass);
  void draw_from_above(const Pass& pass);
  void draw_from_below(const Pass& pass);
  void draw_naively(const Pass& pass);
  void draw_objects(const Pass& pass, ObjectPart part, ObjectChoice choice, GLuint mark);
  [[nodiscard]] DrawState over_surface(const Pass& pass) const;
  void draw_ground(const Pass& pass, DrawState state) const;
  void draw_sky(const Pass& pass);
  void draw_inner_sphere(const Pass& pass);
  void draw_far_side_curtain(const Pass& pass);
  void draw_limb(const Pass& pass, bool in_place);
  /// The state with which the passes of a picture begin: the nearer front face wins, in the eye's colours and rows.
  [[nodiscard]] DrawState picture_state(const EyePicture& eye) const;
  [[nodiscard]] std::optional<StencilState> stencil(const EyePicture& eye, const Marks& marks) const;
  enum class DepthTest { nearer, nearer_or_equal };
  [[nodiscard]] DepthState depth(DepthTest test) const;
  /// Depth of pixels in which nothing has been drawn.
  [[nodiscard]] double no_depth() const { return options_.depth == DepthMode::reversed ? 0.0 : 1.0; }

  // globe_callers.cpp: drawing of the application's own.
  void draw_callers(const Pass& pass, DrawStage stage);

  // globe_targets.cpp: from the picture to the caller's framebuffer.
  Status fit_targets(const FrameInput& input, PictureMemory& memory, GLuint framebuffer);
  Status fit_targets(const FrameTargets::Form& form, PictureMemory& memory);
  void hand_over(const FrameInput& input, GLuint framebuffer);
  static Status prepare_copy(gl::Program& program, std::string_view fragment, bool samples);
  static void copy_samples(const gl::Program& program, GLuint texture, GLuint framebuffer, const DrawState& state,
                           const FrameTargets& from, glm::ivec2 corner_px);

  // globe_layers.cpp, globe_surface.cpp: the image layers.
  [[nodiscard]] PatchScene scene_of(const Pass& pass) const;
  Status prepare_layers(const Pass& pass);
  void plan_stacks(const Pass& pass);
  [[nodiscard]] static PatchBuffers& vertices_of(const LayerFrame& layer, const LayerFrame& base);
  [[nodiscard]] static bool shares_vertices(const LayerFrame& layer, const LayerFrame& base);
  Status upload_layers(const FrameInput& input);
  [[nodiscard]] static PatchLight light_of(const FrameInput& input);
  void upload_frame(const Pass& pass);
  [[nodiscard]] glm::vec4 texels_of(const LayerFrame& layer) const;
  void upload_frame(const Pass& pass, const LayerFrame& layer) const;
  void describe_limb(const Pass& pass, FrameBlock& block) const;
  void describe_layer(const Pass& pass, const LayerFrame& layer, FrameBlock& block) const;
  [[nodiscard]] static glm::vec4 look_of(const Pass& pass, const LayerFrame& layer);
  [[nodiscard]] static glm::vec4 tone_of(const LayerFrame& layer);
  void draw_surface(const Pass& pass) const;
  void draw_layers(const Pass& pass, SurfaceFromBelow look, DrawState state) const;
  void draw_air_before_glass(const Pass& pass, DrawState state) const;
  void draw_layers_translucent(const Pass& pass, DrawState state) const;
  void draw_whole(const Pass& pass, PatchPass::Whole what, const DrawState& state) const;
  void draw_stacks(const Pass& pass, bool first_pass, const DrawState& state) const;
  void draw_base(const Pass& pass, const DrawState& state) const;
  void draw_upper(const Pass& pass, const LayerFrame& layer, const DrawState& state,
                  PatchPass::Limb limb = PatchPass::Limb::raised) const;
  void draw_at_height(const Pass& pass, const LayerFrame& layer, double height, const DrawState& state) const;
  void draw_layers_over_ground(const Pass& pass) const;
  [[nodiscard]] bool is_over_ground(const Pass& pass, const LayerFrame& layer) const;
  [[nodiscard]] static BlendState surface_blend(const SurfaceLook& look);

  // globe_blends.cpp: layers that blend with the picture of the layers below.
  [[nodiscard]] static bool has_blends(const Pass& pass);
  enum class Copy { below, behind };
  [[nodiscard]] bool copy_picture(const Pass& pass, Copy what) const;
  void bind_copy(Copy what) const;
  void draw_on_ground(const Pass& pass, const LayerFrame& layer, const DrawState& state) const;
  void draw_blends_translucent(const Pass& pass, DrawState state) const;

  // globe_sight.cpp: the eyes, and the parts of the planet in their sight.
  [[nodiscard]] static std::vector<EyePicture> pictures_of(const FrameInput& input);
  [[nodiscard]] bool under_ground(const Pass& pass) const;
  [[nodiscard]] SurfaceFromBelow surface_look(const Pass& pass) const;
  [[nodiscard]] double inner_radius_m(const FrameInput& input) const;
  [[nodiscard]] bool has_inner_sphere(const Pass& pass) const;
  [[nodiscard]] double hiding_radius_m(const Pass& pass) const;
  [[nodiscard]] LabelSight label_sight(const Pass& pass) const;
  [[nodiscard]] bool mountains_on_limb(const Pass& pass) const;
  [[nodiscard]] SkyInput sky_of(const Pass& pass) const;
  [[nodiscard]] bool limb_comes_last(const Pass& pass) const;
  [[nodiscard]] LimbLook limb_look(const Pass& pass, const AirTextures* air) const;
  [[nodiscard]] double near_m(const Pass& pass) const;

  RenderOptions options_;
  Ellipsoid ellipsoid_;
  ContextMark context_;
  int longest_side_px_ = FrameTargets::longest_side_px();
  bool relief_ = false;
  std::unique_ptr<PatchPass> patches_;
  PatchStacks stacks_;
  std::vector<StackLayer> stack_layers_;   ///< the layers of the frame that is drawn
  bool ground_in_stacks_ = false;          ///< stacks draw what lies on the ground
  std::unique_ptr<SlopeTextures> slopes_;  ///< only with relief
  std::unique_ptr<LimbPass> limb_;
  std::unique_ptr<OutlinePass> outline_;
  std::unique_ptr<InnerSpherePass> inner_sphere_;
  std::unique_ptr<InterlacePass> interlace_;
  std::unique_ptr<SkyPass> sky_;
  const AirTextures* air_ = nullptr;  ///< air of the eye whose picture is drawn; null: none
  std::optional<NightLights> night_lights_;
  std::unique_ptr<ObjectPass> objects_;
  std::vector<std::byte> label_font_;
  FrameTargets* targets_ = nullptr;  ///< targets of the view that is drawn
  std::vector<std::weak_ptr<FrameTargets>> all_targets_;
  gl::Program depth_copy_, depth_samples_copy_, color_samples_copy_;
  FrameBlock frame_{};  ///< uniforms of the eye whose picture is drawn
  gl::Buffer frame_block_;
};

}  // namespace terrella
