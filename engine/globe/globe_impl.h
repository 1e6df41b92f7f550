#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "globe/globe.h"
#include "globe/image_layer.h"
#include "globe/tile_stream.h"
#include "render/globe_renderer.h"
#include "surface/plan/frame_plan.h"
#include "surface/relief.h"
#include "tiles/arrival_bell.h"
#include "tiles/height_loader.h"

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

/// The implementation of Globe. Globe has checked thread and context before each call. thread: main
struct Globe::Impl {
  explicit Impl(const GlobeOptions& o) : options(o) {}

  // Layers.
  Result<LayerId> add_imagery(std::shared_ptr<TileSource> source, const ImageLook& look);
  Status set_look(LayerId id, const ImageLook& look);
  [[nodiscard]] Result<ImageLook> look(LayerId id) const;
  Status move(LayerId id, std::size_t position);
  Status remove(LayerId id);
  Result<LayerId> add_objects(ObjectScene scene, bool shown);
  Status set_objects(LayerId id, ObjectScene scene);
  Status show_objects(LayerId id, bool shown);
  Status fade_objects(LayerId id, double opacity);
  Status set_attribution(LayerId id, std::string text);
  [[nodiscard]] std::vector<std::string> attributions() const;
  Status set_elevation(const std::optional<ElevationSource>& elevation);
  void make_relief(const ElevationSource& elevation);
  Status show_objects();
  [[nodiscard]] CutScene cut_scene(ObjectLayer& layer, Angle step);
  void share_gpu();
  [[nodiscard]] ImageLayer* image(LayerId id) const;
  [[nodiscard]] ObjectLayer* object(LayerId id);
  [[nodiscard]] LayerId next_id() { return static_cast<LayerId>(++last_id); }

  // A frame.
  FrameStats draw(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px);
  void stack_layers();
  [[nodiscard]] Viewport eye_picture(Viewport viewport) const;
  void look(Viewport viewport);
  [[nodiscard]] PatchSelectionOptions selection_options() const;
  [[nodiscard]] FrameSnapshot snapshot();
  void execute_plan();
  void count();
  void take_heights();
  void ask_heights();
  std::size_t take_finished();
  [[nodiscard]] FrameInput frame_input(Viewport viewport, glm::ivec2 corner_px);
  [[nodiscard]] std::optional<SkyInput> sky() const;
  [[nodiscard]] glm::dvec3 sun() const;
  [[nodiscard]] bool has_night() const { return almanac && options.time && !options.unlit; }
  [[nodiscard]] Ground ground() const { return {options.body.ellipsoid, relief}; }
  [[nodiscard]] double ground_m() const { return relief ? relief->height_m(camera.eye.lat, camera.eye.lon) : 0.0; }
  [[nodiscard]] GlobePick pick(const View& eye, glm::dvec2 pixel_px) const;
  [[nodiscard]] bool shows(const ImageLayer& layer, const Geodetic& place) const;
  [[nodiscard]] bool settled() const;
  [[nodiscard]] bool needs_frame() const;
  void restore_detail();

  /// False if a call comes from another thread than the globe's, or without the globe's context. Reports the misuse by
  /// an assertion.
  [[nodiscard]] bool may_call(const char* call) const;
  [[nodiscard]] bool may_draw(const char* call) const;

  const std::thread::id thread = std::this_thread::get_id();
  GlobeOptions options;
  Camera camera;
  std::shared_ptr<Relief> relief;  ///< shared with each Ground; none: the ellipsoid
  std::shared_ptr<ArrivalBell> bell = std::make_shared<ArrivalBell>();  ///< rung when a tile of any kind has arrived
  std::optional<TileStream<HeightTile>> heights;                        ///< set if relief is
  std::string heights_attribution;
  std::uint64_t last_id = 0;
  std::vector<std::unique_ptr<ImageLayer>> images;  ///< lowest first
  std::unique_ptr<ImageLayer> plain;                ///< made if no image layer is opaque
  std::vector<ImageLayer*> stack;                   ///< layers that a frame draws, lowest first; the lowest is opaque
  std::vector<ObjectLayer> objects;
  std::size_t objects_cut = 0;  ///< since the last frame
  std::unique_ptr<GlobeRenderer> renderer;
  View view;  ///< view for selection: the eye's, or both eyes'
  std::optional<EyePair> eyes;
  std::optional<Almanac> almanac;  ///< set if there is a sky or a time
  bool sky_on = false;
  std::optional<unsigned> patch_shuffle;
  std::uint64_t frame = 0;
  Viewport drawn;       ///< viewport of the last frame
  bool changed = true;  ///< something changed since the last frame
  bool was_settled = false;
  std::function<void()> on_settled;
  FramePlan plan;  ///< of the last frame, whose memory the next one uses again
  FrameStats stats;
  Status status = Done{};  ///< of the last frame
  std::deque<LackingTile> lacking, lacking_heights;
};

}  // namespace terrella
