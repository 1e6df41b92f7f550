#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "globe/experiments.h"
#include "globe/globe.h"
#include "globe/height_layer.h"
#include "globe/image_layer.h"
#include "render/gl/gl_state.h"
#include "render/globe_renderer.h"
#include "surface/plan/frame_plan.h"
#include "tiles/arrival_bell.h"

namespace terrella {

/// Objects that are added and removed together.
struct ObjectLayer {
  LayerId id = LayerId::none;
  ObjectScene scene;
  bool shown = true;
  double opacity = 1.0;
  std::string attribution = {};
  // Computed when first needed, and kept until the layer itself changes.
  std::optional<Angle> line_length = {};
  std::optional<CutObjects> cut = {};
  std::optional<ObjectScene> faded = {};  ///< set if opacity is less than 1

  [[nodiscard]] bool is_drawn() const { return shown && opacity > 0.0 && !scene.empty(); }
};

/// Restores the GL state of the caller when a call ends; null if the caller wants no state restored.
using GlScope = std::unique_ptr<GlState>;

/// Says when a frame draws its picture, after it has taken and requested tiles.
enum class Draw { always, when_settled };

/// The state of a Globe. Functions of Globe call may_call() or may_draw() first. thread: main
struct Globe::Impl {
  explicit Impl(const GlobeOptions& o) : options(o) {}

  /// Fails if a call comes from another thread than the globe's. Reports the misuse by an assertion.
  [[nodiscard]] Status may_call(const char* call) const;
  /// The same for a call that uses OpenGL; also fails without the globe's context. Sets the GL state that drawing
  /// depends on.
  [[nodiscard]] Result<GlScope> may_draw(const char* call) const;

  // Layers.
  [[nodiscard]] ImageLayer* image(LayerId id) const;  ///< null if there is none
  [[nodiscard]] ObjectLayer* object(LayerId id);
  [[nodiscard]] LayerId next_id() { return static_cast<LayerId>(++last_id); }
  [[nodiscard]] LayerSetup setup() { return {options, experiments.mapping, bell}; }
  void share_gpu();
  Status upload_objects();
  [[nodiscard]] CutScene cut_scene(ObjectLayer& layer, Angle step);
  [[nodiscard]] Relief* relief() const { return heights ? heights->relief().get() : nullptr; }

  // A frame.
  FrameStats draw(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px, Draw when);
  void draw_picture(unsigned framebuffer, const FrameInput& input);
  void tell_settled();
  void stack_layers();
  [[nodiscard]] Viewport eye_picture(Viewport viewport) const;
  void look(Viewport viewport);
  [[nodiscard]] PatchSelectionOptions selection_options() const;
  [[nodiscard]] FrameSnapshot snapshot();
  void execute(FramePlan& plan);
  void plan(Viewport viewport);
  void count();
  std::size_t take_finished();
  [[nodiscard]] FrameInput frame_input(Viewport viewport, glm::ivec2 corner_px);
  [[nodiscard]] std::optional<SkyInput> sky() const;
  [[nodiscard]] glm::dvec3 sun() const;
  [[nodiscard]] bool has_night() const { return almanac && options.time && !options.unlit; }
  [[nodiscard]] Ground ground() const { return {options.body.ellipsoid, heights ? heights->relief() : nullptr}; }
  [[nodiscard]] bool shows(const ImageLayer& layer, const Geodetic& place) const;
  [[nodiscard]] bool settled() const;
  void restore_detail();

  const std::thread::id thread = std::this_thread::get_id();
  GlobeOptions options;
  Experiments experiments;
  Camera camera;
  std::shared_ptr<ArrivalBell> bell = std::make_shared<ArrivalBell>();  ///< rung when a tile of any kind has arrived
  std::unique_ptr<HeightLayer> heights;                                 ///< none: the ellipsoid
  std::uint64_t last_id = 0;
  std::vector<std::unique_ptr<ImageLayer>> images;  ///< lowest first
  std::unique_ptr<ImageLayer> plain;                ///< made if the lowest image layer is not opaque
  std::vector<ImageLayer*> stack;                   ///< layers that a frame draws: the opaque base layer, upper layers
  std::vector<ObjectLayer> objects;
  std::size_t objects_cut = 0;  ///< since the last frame
  std::unique_ptr<GlobeRenderer> renderer;
  View view;  ///< view for selection: the eye's, or both eyes'
  std::optional<EyePair> eyes;
  std::optional<Almanac> almanac;  ///< set if there is a sky or a time
  bool sky_on = false;
  std::uint64_t frame = 0;
  Viewport drawn;           ///< viewport of the last frame
  unsigned drawn_into = 0;  ///< framebuffer of the last frame
  bool changed = true;      ///< something changed since the last frame
  bool was_settled = false;
  std::function<void()> on_settled;
  std::function<void(DrawStage, const FrameMatrices&)> on_draw;
  FramePlan last_plan;  ///< the next plan uses its memory again
  FrameStats stats;
  Status status = Done{};  ///< of the last frame
  std::deque<MissingTile> missing, missing_heights;
};

/// Returns the error of a call that names a layer which the globe does not have. thread: any
[[nodiscard]] Error no_layer(const char* call, const char* kind, LayerId id);
/// Fails if an opacity is not from 0 to 1. thread: any
[[nodiscard]] Status check_opacity(const char* call, double opacity);

/// Moves the element at `from` so that `position` others are before it, or to the end.
template <class T>
void move_to(std::vector<T>& all, typename std::vector<T>::iterator from, std::size_t position) {
  const auto to = all.begin() + static_cast<std::ptrdiff_t>(std::min(position, all.size() - 1));
  from < to ? std::rotate(from, from + 1, to + 1) : std::rotate(to, from, from + 1);
}

}  // namespace terrella
