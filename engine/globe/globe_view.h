#pragma once

#include <chrono>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "geo/coordinates.h"
#include "globe/frame_stats.h"
#include "view/frame_matrices.h"
#include "view/render_modes.h"

namespace terrella {

class Globe;

/// A view of a globe: a camera with its own frames, beside other views of the same globe. An overview map and a split
/// screen are further views. All views share the globe's layers, tiles, textures and objects, and look alike.
///
/// The globe keeps and requests the tiles of all views together, those of a view that is not drawn any more too:
/// destroy such a view. Image layers divide their room among the views if the views want more tiles than fit. All views
/// of a globe are drawn in the globe's context. A window with a context of its own shows a texture into which a view
/// was drawn, because contexts do not share vertex arrays and framebuffers.
///
/// thread: main for every call and the destructor, as for Globe. A view may outlive its globe. Then its calls return an
/// error or do nothing.
class GlobeView {
 public:
  /// Makes a further view. It costs nothing until it is drawn.
  [[nodiscard]] static Result<std::unique_ptr<GlobeView>> create(Globe& globe);
  ~GlobeView();
  GlobeView(const GlobeView&) = delete;
  GlobeView& operator=(const GlobeView&) = delete;

  // Each call does for this view what the call of Globe with the same name does for the main view.
  void set_camera(const Camera& camera);
  [[nodiscard]] const Camera& camera() const;
  void set_stereo(const StereoLook& stereo);  ///< initially off
  FrameStats render(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px = {0, 0});
  [[nodiscard]] const FrameStats& last_frame() const;
  [[nodiscard]] const Status& status() const;
  void on_draw(std::function<void(DrawStage stage, const FrameMatrices& matrices)> draw);
  [[nodiscard]] unsigned depth_texture() const;
  Status copy_depth(unsigned framebuffer, glm::ivec2 corner_px = {0, 0});
  [[nodiscard]] bool settled() const;
  void on_settled(std::function<void()> told);
  [[nodiscard]] bool needs_frame() const;
  [[nodiscard]] bool needs_frame(unsigned framebuffer, Viewport viewport) const;
  bool render_until_settled(unsigned framebuffer, Viewport viewport, std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] std::vector<std::string> attributions() const;
  [[nodiscard]] std::optional<double> finest_texel_m() const;
  [[nodiscard]] GlobePick pick(glm::dvec2 pixel_px, Viewport viewport) const;
  [[nodiscard]] std::optional<glm::dvec2> project(const Geodetic& place, Viewport viewport) const;
  [[nodiscard]] View view(Viewport viewport) const;

 private:
  friend class Globe;
  struct Impl;
  explicit GlobeView(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrella
