#pragma once

#include <cstddef>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
#include "render/gl/gl_handle.h"
#include "render/gl/shader_functions.h"
#include "render/sky/air_textures.h"
#include "render/surface/ground_textures.h"
#include "render/surface/patch_buffers.h"
#include "render/surface/patch_ground.h"
#include "render/surface/patch_layer.h"
#include "render/surface/patch_stacks.h"
#include "render/surface/tile_textures.h"
#include "surface/limb.h"
#include "surface/plan/patch_selection.h"
#include "surface/plan/tile_coverage.h"
#include "view/render_modes.h"

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella {

/// Light and filter of a frame's surface; each combination has programs of its own, made when first needed.
struct PatchLight {
  bool relief = false;   ///< slopes are lit; the caller uploads and binds them (SlopeTextures)
  bool bicubic = false;  ///< magnified pictures are filtered bicubically
  bool glint = false;    ///< the sea mirrors the Sun
  static constexpr std::size_t kCount = 8;
  [[nodiscard]] int index() const { return (relief ? 1 : 0) + (bicubic ? 2 : 0) + (glint ? 4 : 0); }
};

/// Options that determine the programs. Changing them needs a new renderer.
struct RenderOptions {
  Texturing texturing = Texturing::automatic;
  DepthMode depth = DepthMode::reversed;
  bool regolith = false;                          ///< lights the surface as dust without air (shaders/regolith.glsl)
  PatchLight light = {};                          ///< light of the first frame; `relief` follows from the heights
  bool night_lights = false;                      ///< draws day, night and city lights; the caller binds NightLights
  std::optional<ShaderFunctions> functions = {};  ///< none: the driver's functions if they are accurate enough
};

struct FrameCounts {
  int draw_calls = 0;
  long triangles = 0;
  bool no_memory = false;         ///< the driver has refused memory for a part of the picture
  bool objects_left_out = false;  ///< the driver has refused memory for an object layer
};

/// Air, light and limb of the surface in a picture. Programs and draws follow from them.
struct PatchScene {
  const AirTextures* air = nullptr;  ///< the ground is seen through this air; null: without air
  PatchLight light = {};
  std::optional<glm::dvec3> sun = {};  ///< city lights shine under this Sun (unit vector, ECEF axes); none: no lights
  /// The ground in this ring is raised, so that each pixel on the limb shows its own (FrameBlock::limb); none: none is.
  std::optional<LimbRing> limb = {};
  /// Longest pixel, in texels, that plain patches integrate with three taps. Longer ones take up to 16.
  double plain_footprint_texels = kPlainFootprint_texels;
  double paper_band = 0.05;  ///< width of the pole bands of Texturing::paper: a fraction of the picture's height
};

/// The part of a layer in the picture; each part has programs of its own.
enum class LayerRole {
  base,     ///< opaque
  upper,    ///< premultiplied by the tiles' alpha and the opacity in the frame's uniform block
  special,  ///< upper, and LayerFrame::special
  blended,  ///< special, and LayerFrame::blend is not normal: reads a copy of the picture below (globe_blends.cpp)
};

/// Draws the patches of the surface, layer by layer, with a state that the caller gives. Owns their programs. The
/// caller has bound the framebuffer and the frame's uniform block. thread: main (of the context)
class PatchPass {
 public:
  /// `has_relief`: the patches have heights.
  [[nodiscard]] static std::unique_ptr<PatchPass> create(const RenderOptions& options, bool has_relief);
  /// Draws patches with or without heights from now on. The programs stay.
  void set_relief(bool has_relief);
  /// Draws in this scene from now on.
  void set_scene(const PatchScene& scene) { scene_ = scene; }
  /// Builds the programs that draw these patches of a layer of pictures or numbers in the scene, each once; for upper
  /// layers also that of Whole::black. `own` as upload() has it.
  Status prepare(LayerRole role, TexelKind kind, const std::vector<SelectedPatch>& patches,
                 const std::vector<bool>& own);
  /// The vertices from which a layer is drawn: its own, of its tree, or those of the base layer and its tree.
  struct Vertices {
    PatchBuffers& buffers;
    const PatchTree& tree;
    bool own;
  };
  /// Uploads a layer's draws, once per frame for both eyes. `coverage` has one entry per patch. `own`: false for
  /// patches to leave out; empty: none.
  void upload(PatchLayer& layer, const Vertices& vertices, const std::vector<SelectedPatch>& patches,
              const TileCoverage& coverage, const std::vector<bool>& own, std::uint64_t frame) const;

  /// Decides which passes draw several layers at once. `layers`: all of a frame, the lowest first. The first `stacked`
  /// share the rows of the base layer's grid and lie on the ground; the others are drawn one by one.
  /// `ground`: what lies on the ground is drawn with the layers; null: nothing, or by draw_ground().
  void plan(std::span<const StackLayer> layers, std::size_t stacked, const GroundFrame* ground, PatchStacks& out) const;
  /// Builds the programs of stacks in the scene, each once.
  Status prepare(const PatchStacks& stacks);
  /// Uploads the draws of planned stacks.
  void upload(PatchStacks& stacks, std::span<const StackLayer> layers, const Vertices& base, std::uint64_t frame) const;
  /// Draws the first pass of the stacks, or the later ones. `base`: the base layer, after its upload.
  void draw_stacks(const PatchStacks& stacks, bool first_pass, std::span<const StackLayer> layers,
                   const PatchLayer& base, const PatchBuffers& vertices, const GroundDraw& ground,
                   const DrawState& state, FrameCounts& counts) const;
  /// The limb of a layer that lies on the ground is raised with the ground (PatchScene::limb).
  enum class Limb { raised, flat };
  /// Draws a layer, program by program. Needs prepare().
  void draw(const PatchLayer& layer, const PatchBuffers& vertices, const TileTextures& tiles, LayerRole role,
            const DrawState& state, FrameCounts& counts, Limb limb = Limb::raised) const;
  /// Builds the programs that draw what lies on the ground, each once.
  Status prepare_ground(const GroundFrame& ground, const std::vector<SelectedPatch>& patches);
  /// Uploads the cells and the draws of what lies on the ground.
  void upload_ground(PatchGround& out, const GroundFrame& ground, const Vertices& vertices,
                     const std::vector<SelectedPatch>& patches, std::uint64_t frame) const;
  /// Draws what lies on the ground, over the depth of the base layer.
  void draw_ground(const GroundDraw& ground, const PatchLayer& base, const PatchBuffers& vertices,
                   const DrawState& state, FrameCounts& counts) const;
  /// Depth only, with the same bits as those of draw(); or with that depth opaque black, the light of the air, or a
  /// copy of the picture behind the surface.
  enum class Whole { depth, black, air, behind };
  /// Makes the programs of draw_whole() for the scene, once. prepare() does so for `black`.
  Status prepare_whole(Whole what);
  /// Draws the whole surface. Needs prepare_whole().
  void draw_whole(Whole what, const PatchLayer& layer, const PatchBuffers& vertices, const DrawState& state,
                  FrameCounts& counts);

 private:
  static constexpr int kPrograms = PatchLayer::kPrograms, kVariants = PatchLayer::kVariants;

  PatchPass(const RenderOptions& options, bool has_relief)
      : options_(options), has_relief_(has_relief), scene_{.light = options.light} {}
  /// 0: ground without air before it; 1: with air, far from the ground; 2: with air, near the ground.
  [[nodiscard]] std::size_t which() const { return scene_.air == nullptr ? 0 : scene_.air->near_ground() ? 2 : 1; }
  /// The part of the light that programs for a role, for pictures or numbers, differ by.
  [[nodiscard]] PatchLight light_of(LayerRole role, TexelKind kind) const {
    const PatchLight& light = scene_.light;
    return {.relief = light.relief,
            .bicubic = light.bicubic && kind == TexelKind::pictures,
            .glint = light.glint && kind == TexelKind::pictures && role == LayerRole::base};
  }
  /// Place in sets_ of the programs for a role, for pictures or numbers, in the present air and this light.
  [[nodiscard]] std::size_t set_index(LayerRole role, TexelKind kind, const PatchLight& light) const {
    const std::size_t layers = kKinds * static_cast<std::size_t>(role) + static_cast<std::size_t>(kind);
    return (layers * kAirs + which()) * PatchLight::kCount + static_cast<std::size_t>(light.index());
  }
  Status make_program(gl::Program& place, int variant, LayerRole role, TexelKind kind);
  /// Features of a program that not all patches of a layer need.
  struct Extras {
    bool city_lights = false, pole = false, limb = false;
    int stack = 0;  ///< layers of a stack; 0: none
    bool ground_alone = false;
    unsigned ground = 0;  ///< GroundFrame::windows, z: draws what lies on the ground; 0: nothing
  };
  Status build(gl::Program& place, std::vector<std::string_view> fragment, LayerRole role, TexelKind kind,
               const Extras& extras) const;
  [[nodiscard]] gl::VertexArray make_vertex_array() const;
  void set_up_vertex_arrays();
  [[nodiscard]] gl::VertexArray make_stack_array() const;
  static void add_ground_attribute(const gl::VertexArray& array);
  void bind_ground(const gl::VertexArray& array, const GroundDraw& ground) const;
  static void set_points(GLuint program, const PatchBuffers& vertices);
  /// Unit of the cells of what lies on the ground: relief has taken one, and leaves another.
  [[nodiscard]] GLuint ground_cells_unit() const { return has_relief_ ? 13 : 9; }
  [[nodiscard]] std::uint64_t ground_place(std::uint32_t look) const { return stack_place(look) | relief_bit(); }
  /// The bit of a program's place that says where the cells of the ground are (ground_cells_unit()).
  [[nodiscard]] std::uint64_t relief_bit() const { return has_relief_ ? 1U << 16U : 0U; }
  void set_up_samplers();
  void bind_vertices(const gl::VertexArray& vertex_array, const PatchLayer& layer, const PatchBuffers& vertices) const;
  /// The command that draws a patch with the attributes of an instance.
  [[nodiscard]] static DrawCommand command_of(const SelectedPatch& patch, std::size_t instance,
                                              const Vertices& vertices, std::uint64_t frame);
  /// The command that draws the triangles of a patch at the limb, whose indices it appends.
  [[nodiscard]] DrawCommand limb_of(DrawCommand patch, const PatchBuffers& buffers,
                                    std::vector<std::uint16_t>& indices) const;
  /// Layers that show on a patch, the lowest first, each with the number of the patch among its own.
  using Shown = std::vector<std::pair<std::uint16_t, std::uint32_t>>;
  void add_groups(std::span<const StackLayer> layers, std::uint32_t patch, const Shown& shown, bool whole,
                  unsigned ground, PatchStacks& out) const;
  void bind_stack(const PatchStacks::Group& group, std::span<const StackLayer> layers, GLuint program) const;
  Status make_stack_program(gl::Program& place, const StackProgram& program);
  Status choose_functions();
  /// Place in stack_programs_ of a StackProgram::key() in the present air and light.
  [[nodiscard]] std::uint64_t stack_place(std::uint32_t key) const {
    return std::uint64_t{key} << 32U | (key >> 29U != 0 ? relief_bit() : 0U) | which() << 8U |
           static_cast<std::uint64_t>(scene_.light.index());
  }
  [[nodiscard]] gl::Program& whole_program(Whole what, bool limb);
  static void draw_commands(int first, int last, FrameCounts& counts);
  [[nodiscard]] PatchLayer::Program program_for(const SelectedPatch& patch) const;
  [[nodiscard]] PatchLayer::Program polar_for(const SelectedPatch& patch) const;
  [[nodiscard]] int variant_for(const SelectedPatch& patch) const;
  [[nodiscard]] int limb_variant_for(const SelectedPatch& patch) const;
  [[nodiscard]] bool is_on_limb(const SelectedPatch& patch) const;
  /// True if city lights may shine on a part of the patch.
  [[nodiscard]] bool is_dark(const PatchNode& node) const;
  /// Longest pixel, in texels, that seven taps suffice for.
  [[nodiscard]] double most_of_seven() const;

  RenderOptions options_;
  bool has_relief_;
  PatchScene scene_;
  /// The programs of a role, for pictures or numbers, by which() air, in a light; those that some patch has needed.
  struct ProgramSet {
    gl::Program programs[kVariants];
    gl::Program air;
  };
  static constexpr std::size_t kRoles = 4, kKinds = 3, kAirs = 3;
  ProgramSet sets_[kRoles * kKinds * kAirs * PatchLight::kCount];
  gl::Program depth_programs_[2], flat_programs_[2], behind_programs_[2];  ///< for whole patches, and for the limb
  std::map<std::uint64_t, gl::Program> stack_programs_;
  std::map<std::uint64_t, gl::Program> ground_programs_;  ///< by ground_place() of PatchGround::Batch::look
  gl::VertexArray vertex_array_, stack_array_, ground_array_;
  gl::Sampler bilinear_, precise_, mipmapped_;
};

}  // namespace terrella
