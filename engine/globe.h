#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>

#include "geo/body.h"
#include "geo/camera.h"
#include "geo/cube_sphere.h"
#include "geo/objects.h"
#include "geo/result.h"
#include "scene/cube_picture.h"
#include "scene/ground.h"
#include "scene/render_modes.h"
#include "scene/star_catalogue.h"
#include "scene/utc_time.h"
#include "streaming/elevation/elevation_source.h"
#include "streaming/tile_loader.h"
#include "streaming/tile_source.h"

namespace terrella {

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
  SurfaceLook surface;
  double exaggeration = 1.0;  ///< of heights, [0, 100]
  StereoLook stereo;
  /// For tests: an opaque globe's order with blending switched on, to show what paper 2 prevents.
  bool naive_translucency = false;
  bool sky = false;                   ///< stars, Sun, Moon and atmosphere; never with `unlit`
  std::optional<UtcTime> time;        ///< of the sky; none: the Sun stands over the viewer's shoulder and is not drawn
  std::vector<Star> stars;            ///< of the sky
  GreyPicture night_lights;           ///< of the Earth's night side, with a sky and a time; may be empty
  std::vector<std::byte> label_font;  ///< a font file for the labels of objects; empty: no labels
  std::size_t gpu_bytes = 512UL << 20;  ///< tile texture slots
  std::size_t upload_bytes_per_frame = 8UL << 20;
  std::chrono::microseconds upload_time_per_frame{4000};
  /// Patches whose relief is made anew in a frame, about 0.3 ms each, beyond those that the frame cannot do without:
  /// tiles of heights wait, and mountains become finer, frame by frame.
  int relief_meshes_per_frame = 24;
  int workers = 2;  ///< decoder threads
};

/// What one frame did.
struct FrameStats {
  int patches = 0;
  int band_patches = 0;  ///< of those, drawn by a per-fragment program
  int draw_calls = 0;
  long triangles = 0;
  int tiles_wanted = 0;       ///< tiles the view asks for at full quality
  int tiles_missing = 0;      ///< of those, neither on the GPU nor finally failed
  int tiles_lacked = 0;       ///< of those, finally failed
  int patches_uncovered = 0;  ///< patches with a cell without any imagery; 0 once the root tiles are there
  std::size_t uploaded_bytes = 0;
  int heights_missing = 0;       ///< elevation tiles that the view wants and that have not come or failed
  int heights_lacked = 0;        ///< elevation tiles that finally failed, of all that any view wanted
  bool heights_arrived = false;  ///< since it was drawn: another frame will show the ground as it is now
  int relief_meshes = 0;         ///< patches whose relief was made anew
  int relief_put_off = 0;        ///< patches drawn coarser than their relief asks for, for now
  double selection_ms = 0.0;
};

/// A tile that the source could not give, and why.
struct LackingTile {
  TileId id;
  TileFailure failure;
};

/// The globe: give it a current OpenGL 4.5 context, a tile source and a camera; it draws into a framebuffer.
/// thread: main (the thread of the context) for every call.
class Globe {
 public:
  /// Fails if no context is current, it is older than 4.5, a shader does not compile, the time is outside the
  /// almanac's years, or detail, error, segments or gutter are outside their ranges.
  [[nodiscard]] static Result<std::unique_ptr<Globe>> create(const GlobeOptions& options,
                                                             std::shared_ptr<TileSource> imagery,
                                                             std::optional<ElevationSource> elevation = {});
  ~Globe();
  Globe(const Globe&) = delete;
  Globe& operator=(const Globe&) = delete;

  void set_camera(const Camera& camera);
  [[nodiscard]] const Camera& camera() const;
  [[nodiscard]] const GlobeOptions& options() const;
  void set_unlit(bool unlit);
  void set_surface(const SurfaceLook& surface);
  void set_stereo(const StereoLook& stereo);
  void set_sky(bool on);                       ///< nothing if the globe was made without one
  [[nodiscard]] bool has_relief() const;       ///< made with elevation
  void set_exaggeration(double exaggeration);  ///< of heights, [0, 100]
  /// Of the sky; none: as in GlobeOptions. Fails outside the almanac's years, and then changes nothing. City lights are
  /// there only in a globe that was made with a time.
  Status set_time(std::optional<UtcTime> time);
  /// For tests: the seed of another order of patches; none: as they are chosen.
  void set_patch_shuffle(std::optional<unsigned> seed);
  /// In place of those before. Fails if their programs cannot be made.
  Status set_objects(const ObjectScene& objects);

  /// Draws one frame into `framebuffer` (a GL name, 0 the window) and uploads what has arrived, within the budget.
  /// Returns what the frame did. The GL state is changed.
  FrameStats render(unsigned framebuffer, Viewport viewport);

  /// True when the last frame showed everything that its view asks for.
  [[nodiscard]] bool settled() const;
  /// Renders until settled or the deadline; false at the deadline.
  bool render_until_settled(unsigned framebuffer, Viewport viewport, std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] LoaderCounts loading() const;
  /// The tiles that failed last, the latest at the end, at most 64. Those that could not be asked for (Absence::failed)
  /// are asked for again after half a minute, if they are still wanted.
  [[nodiscard]] const std::deque<LackingTile>& lacking() const;
  /// The same of elevation: coarser heights stand for these tiles, or the ellipsoid.
  [[nodiscard]] const std::deque<LackingTile>& lacking_heights() const;

  /// View of the camera at a picture size: picks and projections (geo/camera.h on the ellipsoid, scene/ground.h on the
  /// ground) take it.
  [[nodiscard]] View view(Viewport viewport) const;
  /// The ground as it is drawn, with the heights that are there; it must not outlive the globe.
  [[nodiscard]] Ground ground() const;
  /// Height of the drawn ground over the ellipsoid, exaggerated, where the heights that are there say it; 0 without
  /// any.
  [[nodiscard]] double ground_height_m(Angle lat, Angle lon) const;
  /// The same not exaggerated; nothing without heights.
  [[nodiscard]] std::optional<double> elevation_m(Angle lat, Angle lon) const;

 private:
  struct Impl;
  explicit Globe(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrella
