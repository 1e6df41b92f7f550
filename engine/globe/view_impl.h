#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "globe/globe.h"
#include "globe/ground_pictures.h"
#include "globe/height_layer.h"
#include "globe/layer_view.h"
#include "render/gl/gl_state.h"
#include "render/globe_renderer.h"
#include "surface/plan/frame_plan.h"
#include "view/stereo.h"

namespace terrella {

/// Restores the GL state of the caller when a call ends; null if the caller wants no state restored.
using GlScope = std::unique_ptr<GlState>;

/// Says when a frame draws its picture, after it has taken and requested tiles. A frame that never does requests
/// heights only.
enum class Draw { always, when_settled, never };

/// The state of a GlobeView. Functions of Globe and GlobeView call may_call() or may_draw() first. `call` is the name
/// of the call for messages. thread: main
struct GlobeView::Impl {
  Impl(Globe::Impl& of, ViewId name) : globe(&of), id(name) {}

  /// Fails if a call comes from another thread than the globe's, or if the globe is gone.
  [[nodiscard]] Status may_call(const char* call) const;
  /// The same for a call that uses OpenGL; see Globe::Impl::may_draw().
  [[nodiscard]] Result<GlScope> may_draw(const char* call) const;
  /// True on the globe's thread, also if the globe is gone. Else reports the misuse.
  [[nodiscard]] bool on_thread(const char* call) const;
  /// True if a call may set a value; `good` is the check of the value. A value that is out of range is refused: the
  /// next frame draws nothing, and status() is the error.
  [[nodiscard]] bool may_set(const char* call, const Status& good);
  /// Fails if a setting was refused since the last frame, or if the frame's own values are out of range.
  [[nodiscard]] Status may_begin(const char* call, Viewport viewport, glm::ivec2 corner_px);

  void set_camera(const Camera& to);
  void set_stereo(const StereoLook& look);
  FrameStats render(const char* call, unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px,
                    Draw when = Draw::always);
  bool render_until_settled(const char* call, unsigned framebuffer, Viewport viewport,
                            std::chrono::steady_clock::time_point deadline);
  bool settle_heights(const char* call, unsigned framebuffer, Viewport viewport,
                      std::chrono::steady_clock::time_point deadline);
  Status copy_depth(const char* call, unsigned framebuffer, glm::ivec2 corner_px);
  [[nodiscard]] unsigned depth_texture() const { return memory.has_picture() ? memory.targets->depth() : 0; }
  void set_on_draw(std::function<void(DrawStage, const FrameMatrices&)> draw);
  [[nodiscard]] const Status& last_status(const char* call) const;
  [[nodiscard]] bool settled() const;
  [[nodiscard]] bool has_settled_heights() const;
  [[nodiscard]] bool needs_frame() const;
  [[nodiscard]] bool needs_frame(unsigned framebuffer, Viewport viewport) const;
  [[nodiscard]] std::vector<std::string> attributions() const;
  [[nodiscard]] std::optional<double> finest_texel_m() const;
  [[nodiscard]] View eye_view(Viewport viewport) const;
  [[nodiscard]] View eye_view(const char* call, Viewport viewport) const;
  [[nodiscard]] GlobePick pick(glm::dvec2 pixel_px, Viewport viewport) const;
  [[nodiscard]] std::optional<glm::dvec2> project(const Geodetic& place, Viewport viewport) const;

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
  void plan(Viewport viewport, Draw when);
  void plan_ground();
  [[nodiscard]] double clearance_m() const;
  void count();
  [[nodiscard]] std::vector<HeightLayer::Viewer> viewers() const;
  void take_heights();
  [[nodiscard]] FrameInput frame_input(Viewport viewport, glm::ivec2 corner_px);
  [[nodiscard]] std::optional<SkyInput> sky() const;
  [[nodiscard]] glm::dvec3 sun() const;
  [[nodiscard]] bool shows(const ImageLayer& layer, const Geodetic& place) const;
  [[nodiscard]] bool is_hidden(std::size_t layer) const;
  void restore_detail();

  Globe::Impl* globe;  ///< null: the globe is gone
  ViewId id;
  const std::thread::id thread = std::this_thread::get_id();
  Camera camera;
  StereoLook stereo;
  std::vector<LayerView*> stack;    ///< layers that the last frame drew: the opaque base layer, upper layers
  std::vector<LayerView*> planned;  ///< the stack, then layers that are coming
  bool is_behind = false;           ///< a layer took another's place since the last frame
  PictureMemory memory;
  ViewGround ground;
  View view;  ///< view for selection: the eye's, or both eyes'
  std::optional<EyePair> eyes;
  std::uint64_t frame = 0;                             ///< number of the last frame; 0: none
  Viewport drawn;                                      ///< viewport of the last frame
  unsigned drawn_into = 0;                             ///< framebuffer of the last frame
  std::pair<Camera, std::optional<UtcTime>> drawn_at;  ///< camera and time of the last frame
  bool still = false;   ///< the last frame had the camera and the time of the frame before, or is for a still
  bool changed = true;  ///< something changed since the last frame
  bool was_settled = false;
  StreamCounts heights_seen;  ///< counts of the heights' stream at the last frame
  std::function<void()> on_settled;
  std::function<void(DrawStage, const FrameMatrices&)> on_draw;
  FramePlan last_plan;  ///< the next plan uses its memory again
  FrameStats stats;
  Status status = Done{};   ///< result of the last frame, or why a setting was refused since then
  Status refused = Done{};  ///< error of a setting since the last frame
};

/// The value, or a default one if the call may not read it.
template <class T>
[[nodiscard]] const T& if_allowed(bool allowed, const T& value) {
  static const T none{};
  return allowed ? value : none;
}

}  // namespace terrella
