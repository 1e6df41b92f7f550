#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/body.h"
#include "geo/camera.h"
#include "geo/cube_sphere.h"
#include "geo/objects.h"
#include "objects/object_pick.h"
#include "sky/cube_picture.h"
#include "sky/star_catalogue.h"
#include "sky/utc_time.h"
#include "surface/layers.h"
#include "tiles/elevation_source.h"
#include "tiles/tile_loader.h"
#include "tiles/tile_source.h"
#include "view/ground.h"
#include "view/render_modes.h"

namespace terrella {

/// A globe's treatment of the OpenGL state that it finds at a call.
enum class GlContract {
  restore,  ///< every call leaves the state as it found it: about 250 queries in a call of render()
  leave,    ///< a call asks for no state and restores none; the caller sets what it needs itself afterwards
};

struct GlobeOptions {
  Body body = earth();
  Texturing texturing = Texturing::automatic;
  double paper_a = 4.0;      ///< formula (6)'s a, [2, 8]
  double paper_band = 0.05;  ///< formula (5)'s b, (0, 0.5]
  /// Squeezed tiles near the poles, where the set has them and `texturing` is exact or automatic; else the full grid.
  bool squeezed_rows = true;
  int polar_columns = 32;  ///< a patch that touches a pole takes a coarser level over this many tile columns, [1, 4096]
  /// Detail asked of the imagery, [0.125, 8]: a texel is at most a pixel over this, along the meridian, as far as the
  /// set goes. Tiles, bytes and memory grow with its square; `bench accuracy` has the curve.
  double texels_per_pixel = 1.0;
  /// Farthest that the ellipsoid may be drawn from where it is, and what is interpolated from its place, in pixels,
  /// [0.01, 16]: a patch that would be further off is split.
  double max_error_px = 0.2;
  int segments = 24;  ///< a patch's side in triangles' edges: even, [2, 128]
  CubeMapping mapping = CubeMapping::tangent;
  /// Texels of the neighbours around a tile in its slot, [0, 64], mip k has 2^-k of them. 8 is as far as filtering
  /// reaches; without any, tile borders show.
  int gutter_px = 8;
  DepthMode depth = DepthMode::reversed;
  bool unlit = false;  ///< imagery alone: no light, no sky, black background
  SurfaceLook surface{};
  double exaggeration = 1.0;  ///< of heights, [0, 100]
  StereoLook stereo{};
  /// For tests: an opaque globe's order with blending switched on, to show what paper 2 prevents.
  bool naive_translucency = false;
  bool sky = false;               ///< stars, Sun, Moon and atmosphere; never with `unlit`
  std::optional<UtcTime> time{};  ///< of Sun and sky; none: the Sun stands over the viewer's shoulder, is not drawn,
                                  ///< and it is day everywhere (ImageLook::daylight)
  std::vector<Star> stars{};      ///< of the sky
  GreyPicture night_lights{};     ///< of the Earth's night side, with a sky and a time; may be empty
  std::vector<std::byte> label_font{};     ///< a font file for the labels of objects; empty: no labels
  std::size_t gpu_bytes = 512UL << 20;     ///< tile texture slots, of all image layers together
  std::size_t height_bytes = 256UL << 20;  ///< elevation tiles in main memory; room for 64 tiles at least
  std::size_t upload_bytes_per_frame = 8UL << 20;
  std::chrono::microseconds upload_time_per_frame{4000};
  /// Patches whose relief is made anew in a frame, about 0.3 ms each, beyond those that the frame cannot do without:
  /// tiles of heights wait, and mountains become finer, frame by frame.
  int relief_meshes_per_frame = 24;
  int workers = 2;                               ///< decoder threads
  GlContract gl_contract = GlContract::restore;  ///< the picture is the same with both
  /// A tile of imagery or heights that failed for now (Absence::failed) is requested again after this time, if it is
  /// still wanted. Positive.
  std::chrono::milliseconds retry_after{30'000};
};

/// What one frame did.
struct FrameStats {
  int patches = 0;
  int band_patches = 0;  ///< of those, drawn by a per-fragment program
  int draw_calls = 0;
  long triangles = 0;
  int tiles_wanted = 0;        ///< tiles the view asks for at full quality
  int tiles_missing = 0;       ///< of those, neither on the GPU nor finally failed
  int tiles_lacked = 0;        ///< of those, finally failed
  int patches_uncovered = 0;   ///< patches with a cell without any imagery; 0 once the root tiles are there
  bool imagery_shown = false;  ///< a tile of imagery is in view, be it a coarse one that stands in
  std::size_t uploaded_bytes = 0;
  std::size_t objects_cut = 0;   ///< lines and areas tessellated since the frame before
  int heights_missing = 0;       ///< elevation tiles that the view wants and that have not come or failed
  int heights_lacked = 0;        ///< elevation tiles that failed, of those that views wanted lately
  bool heights_arrived = false;  ///< since it was drawn: another frame will show the ground as it is now
  int relief_meshes = 0;         ///< patches whose relief was made anew
  int relief_put_off = 0;        ///< patches drawn coarser than their relief asks for, for now
  double selection_ms = 0.0;
  // What is held, of all layers that were drawn.
  std::size_t gpu_bytes = 0;     ///< texture slots, filled or not
  std::size_t height_bytes = 0;  ///< elevation tiles
  std::size_t patches_held = 0;  ///< patches worked out, drawn or not
  std::size_t tiles_known = 0;   ///< tiles of imagery of which something is remembered
};

/// A tile that the source could not give, and why.
struct LackingTile {
  TileId id;
  TileFailure failure;
  LayerId layer = LayerId::none;  ///< of imagery
};

/// What is under a pixel.
struct GlobePick {
  std::optional<Geodetic> place{};       ///< of the ground (view/ground.h); nothing beside the globe
  LayerId imagery = LayerId::none;       ///< the highest image layer drawn there, by its bounds
  LayerId objects = LayerId::none;       ///< the layer of the object; none: no object
  std::optional<PickedObject> object{};  ///< in the lists that the layer was given
};

/// What a globe may use; the same as in GlobeOptions.
struct GlobeBudget {
  std::size_t gpu_bytes;
  std::size_t upload_bytes_per_frame;
  std::chrono::microseconds upload_time_per_frame;
  int relief_meshes_per_frame;
};

/// The globe: made in a current OpenGL 4.5 context, anyone's, it draws image layers, heights and objects as a camera
/// sees them into a framebuffer. Every call leaves the GL state as it found it, unless GlobeOptions::gl_contract says
/// otherwise.
///
/// thread: main (the one that it was made on, with its context current) for every call and for the end of its life. A
/// call that is not is told by an assertion that names the call; without assertions what returns a Status or a Result
/// returns an error, render() draws nothing, and the rest does nothing. At the end of its life the context must be
/// current; if none is, its GL objects are gone with the context they were of.
class Globe {
 public:
  /// Without layers: a body in a plain colour. Fails if no context is current, it is older than 4.5, a shader does not
  /// compile, the time is outside the almanac's years, or detail, error, segments or gutter are outside their ranges.
  [[nodiscard]] static Result<std::unique_ptr<Globe>> create(const GlobeOptions& options);
  /// The same with a first image layer and, if there are any, heights.
  [[nodiscard]] static Result<std::unique_ptr<Globe>> create(const GlobeOptions& options,
                                                             std::shared_ptr<TileSource> imagery,
                                                             std::optional<ElevationSource> elevation = {});
  ~Globe();
  Globe(const Globe&) = delete;
  Globe& operator=(const Globe&) = delete;

  /// Over the image layers that are there. Fails without a source, or if it says of its grid what cannot be.
  Result<LayerId> add_imagery(std::shared_ptr<TileSource> source, const ImageLook& look = {});
  /// In place of those before of the layer. Fails if it is no image layer of this globe.
  Status set_look(LayerId imagery, const ImageLook& look);
  [[nodiscard]] Result<ImageLook> look(LayerId imagery) const;
  /// So that `position` others of its kind, imagery or objects, lie under it; over all others if there are no more.
  /// Objects of one kind that lie at the same place are drawn in the order of their layers.
  Status move(LayerId layer, std::size_t position);
  [[nodiscard]] std::vector<LayerId> imagery() const;  ///< the lowest first
  /// Over the object layers that are there. Fails if their programs cannot be made.
  Result<LayerId> add_objects(ObjectScene objects, bool shown = true);
  /// In place of those before of the layer.
  Status set_objects(LayerId layer, ObjectScene objects);
  Status show_objects(LayerId layer, bool shown);
  /// Alpha of its objects times `opacity`, [0, 1]; at 0 they are neither drawn nor picked. What is opaque costs a
  /// little less than what is not.
  Status fade_objects(LayerId layer, double opacity);
  [[nodiscard]] std::vector<LayerId> objects() const;  ///< the lowest first
  /// An image layer or an object layer. Fails if it is not there, or not any more.
  Status remove(LayerId layer);
  /// Whom to thank for a layer, in place of what its source says; objects have nothing until it is said. Empty: nobody.
  Status set_attribution(LayerId layer, std::string text);
  /// What the sources of the last frame want to be said, each text once: of the image layers, the lowest first, that
  /// had a tile in view (under an opaque layer too), of the elevation, of the object layers that were shown.
  [[nodiscard]] std::vector<std::string> attributions() const;
  /// Replaces the elevation; none: the ellipsoid. A Ground from before keeps the heights that it had.
  Status set_elevation(std::optional<ElevationSource> elevation);
  [[nodiscard]] bool has_relief() const;  ///< has elevation

  void set_camera(const Camera& camera);
  [[nodiscard]] const Camera& camera() const;
  [[nodiscard]] const GlobeOptions& options() const;
  void set_unlit(bool unlit);
  void set_surface(const SurfaceLook& surface);
  void set_stereo(const StereoLook& stereo);
  void set_sky(bool on);                       ///< nothing if the globe was made without one
  void set_exaggeration(double exaggeration);  ///< of heights, [0, 100]
  /// Of Sun and sky; none: as in GlobeOptions. Fails outside the almanac's years, and then changes nothing. City lights
  /// are there only in a globe that was made with a time.
  Status set_time(std::optional<UtcTime> time);
  /// From the next frame on. Image layers share the GPU's part evenly, and each has room for 16 tiles at least.
  void set_budget(const GlobeBudget& budget);
  /// For tests: the seed of another order of patches; none: as they are chosen.
  void set_patch_shuffle(std::optional<unsigned> seed);

  /// Draws one frame into `framebuffer` (a GL name, 0 the window), sRGB or not, its lower left corner at `corner_px`,
  /// and uploads what has arrived, within the budget. Returns what the frame did. Draws nothing if status() is an
  /// error.
  FrameStats render(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px = {0, 0});
  /// The error of the last frame, which drew nothing because a shader program that it was the first to need could not
  /// be made. The next frame tries again.
  [[nodiscard]] const Status& status() const;

  /// True when the last frame showed everything that its view asks for.
  [[nodiscard]] bool settled() const;
  /// `told` is called at the end of a frame with which the globe has settled, when the one before had not; none:
  /// nobody. It must not end the globe's life.
  void on_settled(std::function<void()> told);
  /// False if another frame would show what the last one did: nothing was set, nothing has arrived. Costs a few
  /// comparisons; a settled globe changes by itself only where a source that could not be asked is asked again.
  [[nodiscard]] bool needs_frame() const;
  /// Renders until settled or the deadline; false at the deadline, and at once if status() is an error.
  bool render_until_settled(unsigned framebuffer, Viewport viewport, std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] LoaderCounts loading() const;  ///< of all image layers
  /// The tiles that failed last, the latest at the end, at most 64. Those that could not be asked for (Absence::failed)
  /// are requested again after GlobeOptions::retry_after, if they are still wanted.
  [[nodiscard]] const std::deque<LackingTile>& lacking() const;
  /// The same of elevation: coarser heights stand for these tiles, or the ellipsoid.
  [[nodiscard]] const std::deque<LackingTile>& lacking_heights() const;

  /// What a pixel shows, of the one eye's picture (geo/coordinates.h).
  [[nodiscard]] GlobePick pick(glm::dvec2 pixel_px, Viewport viewport) const;
  /// Where a place at its height is in the picture; nothing if it is outside of it, behind the eye or hidden
  /// by the ground.
  [[nodiscard]] std::optional<glm::dvec2> project(const Geodetic& place, Viewport viewport) const;
  /// View of the camera at a picture size: picks and projections (geo/camera.h on the ellipsoid, view/ground.h on the
  /// ground) take it.
  [[nodiscard]] View view(Viewport viewport) const;
  /// The ground as it is drawn. The value stays valid when the globe or its elevation is gone.
  [[nodiscard]] Ground ground() const;
  /// Height of the drawn ground over the ellipsoid, exaggerated, where the heights that are there say it; 0 without
  /// any.
  [[nodiscard]] double ground_height_m(Angle lat, Angle lon) const;
  /// The same not exaggerated; nothing without heights.
  [[nodiscard]] std::optional<double> elevation_m(Angle lat, Angle lon) const;

 private:
  struct Impl;
  [[nodiscard]] static Result<std::unique_ptr<Globe>> make(const GlobeOptions& options,
                                                           const std::optional<ElevationSource>& elevation);
  explicit Globe(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrella
