#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/open_scene/open_scene.h"
#include "apps/open_scene/options/scene_options.h"
#include "apps/viewer/panels/readout.h"
#include "base/result.h"
#include "codecs/image.h"
#include "globe/features/point_clusters.h"
#include "globe/features/shown_features.h"
#include "globe/globe.h"

namespace terrella {

/// Options of `terrella render`.
struct RenderCommand {
  SceneOptions scene;
  std::string output;  ///< empty: no file is written
  bool json = false;
  bool legend = false;
  bool credits = false;
  bool scale_bar = false;
  LengthUnits units = LengthUnits::metric;  ///< units of the scale bar
  int supersample = 1;                      ///< pixels drawn for each one of the picture, along both sides
  bool more_objects = false;                ///< objects with labels may be added to the globe later
};

/// Fails if a picture cannot be drawn as many times larger as the command says. thread: any
[[nodiscard]] Status check_supersample(const RenderCommand& command);
/// Fails if layers shall follow a time that the scene does not have. thread: any
[[nodiscard]] Status check_clock(const SceneOptions& scene);
/// The files, folders and addresses that a scene is drawn from; some are empty. thread: any
[[nodiscard]] std::vector<std::string> inputs_of(const SceneOptions& scene);

/// A picture and the facts of its making.
struct Rendered {
  Image image;
  FrameStats stats;
  std::vector<MissingTile> missing, missing_heights;
  std::vector<std::string> missing_dates;  ///< sentences about dates of the picture that earlier ones stand in for
  std::vector<std::string> attributions;
};

/// "LEVEL/X/Y: why the tile is missing", safe for a terminal. thread: any
[[nodiscard]] std::string name_of(const MissingTile& tile);
/// Height tiles that failed or had not arrived at the deadline. thread: any
[[nodiscard]] int heights_without(const FrameStats& stats);
/// True if no tile of imagery or heights failed or had not arrived. thread: any
[[nodiscard]] bool is_complete(const FrameStats& stats);

/// A globe as the options describe it, in an OpenGL context of its own, without display or GPU. thread: main, for every
/// call and the destructor: the thread that opened it
class ScenePicture {
 public:
  /// The error names the input. Throws CLI::ValidationError if the eye is out of range, and BrokenInstallation.
  [[nodiscard]] static Result<std::unique_ptr<ScenePicture>> open(const RenderCommand& command);
  ~ScenePicture();
  ScenePicture(const ScenePicture&) = delete;
  ScenePicture& operator=(const ScenePicture&) = delete;

  [[nodiscard]] Globe& globe();
  [[nodiscard]] const OpenedScene& scene() const;
  [[nodiscard]] Result<LayerId> add(const OverlayOption& overlay);  ///< on top; see add_overlay()
  /// Forgets the clusters and shown features of a layer whose objects were replaced.
  void forget_features(LayerId layer);
  /// Draws points of an object layer in clusters from now on; a radius of 0: not. For objects that are new.
  [[nodiscard]] Status set_clusters(LayerId layer, std::span<const ClusterPoint> points, double radius_px);
  /// Shows features of an object layer as `features` says from now on, instead of as an earlier call said.
  [[nodiscard]] Status set_shown(LayerId layer, std::vector<ShownWhen> features);
  [[nodiscard]] Camera first_camera() const;   ///< --camera, or default_camera()
  [[nodiscard]] bool has_all_objects() const;  ///< false if the file of --objects has faults
  /// Begins a frame of a film, with its own opacity of the surface and time of the Sun; none: those of the scene.
  /// Forgets tiles that earlier frames loaded, so that draw() gives the same pixels whatever they were
  /// (globe/experiments.h).
  [[nodiscard]] Status begin_frame(std::optional<double> surface_alpha, std::optional<UtcTime> sun);
  /// Shows the features and clusters of a view and the dates of the present time, and keeps them in all later pictures
  /// until the next call: those of one instant for all moments of a blurred frame.
  [[nodiscard]] Status show_features(const Camera& camera);
  /// Draws a view until all its tiles have come or the time is up, then map and legend. An eye in the ground rises.
  /// Fails if no tile came, and after a signal (StopSignals).
  [[nodiscard]] Result<Rendered> draw(const Camera& camera);
  /// The same without map, graticule, legend, credits and scale bar.
  [[nodiscard]] Result<Rendered> draw_scene(const Camera& camera);
  /// Draws these over a picture of that view, for example over the mean of several.
  [[nodiscard]] Status draw_over(const Camera& camera, Image& image);

 private:
  struct Parts;
  explicit ScenePicture(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace terrella
