#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/utc_time.h"
#include "geo/camera.h"
#include "geo/object_edits.h"
#include "geo/objects.h"
#include "globe/frame_stats.h"
#include "globe/globe_options.h"
#include "globe/globe_view.h"
#include "surface/layers.h"
#include "tiles/elevation_source.h"
#include "tiles/tile_loader.h"
#include "tiles/tile_source.h"
#include "view/frame_matrices.h"
#include "view/ground.h"
#include "view/render_modes.h"

namespace terrella {

/// The instants of an image layer, in UTC. None: its source knows no time (TileSetInfo::instant).
struct LayerTime {
  std::optional<UtcTime> shown{};   ///< the tiles on the screen; none too before the first instant (LayerClock)
  std::optional<UtcTime> next{};    ///< the tiles that fade in over these (LayerClock); none: there are no such tiles
  double next_share = 0.0;          ///< part of the colour that `next` has, [0, 1]
  std::optional<UtcTime> coming{};  ///< the tiles on their way to replace them; none: there are no such tiles
};

/// An instant of which an image layer had no tile in view.
struct MissingInstant {
  LayerId layer = LayerId::none;
  UtcTime instant{};
  std::string why;  ///< reason of one missing tile
};

/// A globe that draws image layers, heights and objects as a camera sees them into a framebuffer. It is made in a
/// current OpenGL 4.5 context of any origin. Every call leaves the GL state as it found it, unless
/// GlobeOptions::gl_contract says otherwise.
///
/// A globe has a main view. Calls about the camera, frames and pixels are calls of the main view. Further views
/// (globe/globe_view.h) share the globe's layers, tiles, textures and objects.
///
/// thread: main for every call and the destructor: the thread on which the globe was made, with its context current. A
/// call that breaks this rule is reported by an assertion that names the call. Without assertions, as in the packages,
/// calls that return a Status or a Result return an error, render() draws nothing, and other calls do nothing and
/// return an empty value. The context must be current in the destructor. If no context is current, the GL objects are
/// taken to be gone with their context.
///
/// Each value has the range that its header states; NaN is never in range. A call that returns a Status or a Result
/// fails for a value out of range. Another setting is refused: it stays as it was, status() is an error that names call
/// and value, and the next frame draws nothing. Other calls return an empty value. No such value is an assertion.
class Globe {
 public:
  /// Makes a globe without layers, a body in a plain colour. Fails if no context is current or the context is older
  /// than 4.5. Also fails if the time is outside the almanac's years, or if another option is out of range.
  [[nodiscard]] static Result<std::unique_ptr<Globe>> create(const GlobeOptions& options);
  /// Makes a globe with a base layer and, optionally, heights. Fails as above.
  [[nodiscard]] static Result<std::unique_ptr<Globe>> create(const GlobeOptions& options,
                                                             std::shared_ptr<TileSource> imagery,
                                                             std::optional<ElevationSource> elevation = {});
  ~Globe();
  Globe(const Globe&) = delete;
  Globe& operator=(const Globe&) = delete;

  /// Adds an image layer over the existing ones. The lowest image layer is the base layer, the others are upper layers.
  /// Fails if the source is null, if its description of its grid is invalid, or if the driver has no memory for tiles.
  Result<LayerId> add_imagery(std::shared_ptr<TileSource> source, const ImageLook& look = {});
  /// Replaces the look of an image layer. Fails if `imagery` is not an image layer of this globe, or if a value is out
  /// of range.
  Status set_look(LayerId imagery, const ImageLook& look);
  [[nodiscard]] Result<ImageLook> look(LayerId imagery) const;
  /// Moves a layer so that `position` other layers of its kind (imagery or objects) lie under it; to the top if there
  /// are fewer. Objects of one kind at the same place are drawn in the order of their layers.
  Status move(LayerId layer, std::size_t position);
  [[nodiscard]] std::vector<LayerId> imagery() const;  ///< lowest first
  /// Adds an object layer over the existing ones. Fails if a value of an object is out of range, such as a place that
  /// is not finite or an index beyond a mesh's vertices, or if the shader programs cannot be made.
  Result<LayerId> add_objects(ObjectScene objects, bool shown = true);
  /// Replaces the objects of a layer. Many lines and areas are cut by a worker; until then the layer shows the earlier
  /// objects, and settled() is false.
  Status set_objects(LayerId layer, ObjectScene objects);
  /// Adds, moves, changes and removes single objects of a layer by their ids. The cost depends on the edits alone.
  /// Fails if an id is not in the layer, or if a move or a change has a value out of range; all other edits are made.
  /// Fails and makes no edit if an added object has a value out of range.
  Status edit_objects(LayerId layer, ObjectEdits edits);
  Status show_objects(LayerId layer, bool shown);
  /// Multiplies the alpha of a layer's objects by `opacity`, [0, 1]. At 0 the objects are neither drawn nor picked.
  /// Opaque objects cost slightly less than translucent ones.
  Status fade_objects(LayerId layer, double opacity);
  [[nodiscard]] std::vector<LayerId> objects() const;  ///< lowest first
  /// Removes an image layer or an object layer. Fails if the globe does not have the layer.
  Status remove(LayerId layer);
  /// Requests all tiles of an image layer again, or one of them, because the source's data changed. The earlier tiles
  /// stay on the screen until the new ones arrive. Fails if the globe does not have the image layer.
  Status invalidate(LayerId imagery, std::optional<TileId> tile = {});
  /// Gives an image layer the tiles of another source, such as those of another date. Until the tiles in view have
  /// come, the layer shows those of the earlier source, and settled() is false: no frame mixes the two. If none of them
  /// can be had, the layer keeps the earlier source. A source that is on its way gives way to this one. The look stays,
  /// the attribution text is the source's. Meanwhile the layer takes the room of two (set_budget()). Fails as
  /// add_imagery(), and if the globe does not have the image layer.
  Status set_source(LayerId imagery, std::shared_ptr<TileSource> source);
  /// True while the tiles of another source of an image layer are on their way.
  [[nodiscard]] bool awaits_source(LayerId imagery) const;
  /// Returns the source of the tiles that an image layer shows. Fails if the globe does not have the image layer.
  [[nodiscard]] Result<std::shared_ptr<TileSource>> source(LayerId imagery) const;
  /// Shows an image layer at a time in UTC: at the last instant of its source (TileSetInfo::steps) at or before it. The
  /// tiles come and appear as those of set_source(). Nothing happens if that instant is shown or on its way. If no tile
  /// in view exists or can be had at that instant, up to three earlier instants are tried, and missing_instants() names
  /// it; a later call tries it again. The instants asked for before, two at most, go on loading into their caches; one
  /// that is complete before the wanted one appears meanwhile. Fails if the globe does not have the image layer, if its
  /// source has no instants, or if the time is before the first, which the error names. May open a cache: takes
  /// milliseconds, or seconds while another program writes to that cache.
  Status set_layer_time(LayerId imagery, UtcTime time);
  /// Loads the tiles in view of an image layer at a time that set_layer_time() will show later, for example the next
  /// instant in the direction of play. They follow the view and take a share of the GPU's memory, until
  /// set_layer_time() shows them in the next frame, or until another call replaces them. None: drops them. Nothing
  /// happens if that instant is shown or on its way. Fails as set_layer_time() does.
  Status load_layer_time(LayerId imagery, std::optional<UtcTime> time);
  /// Returns the instants of an image layer. Fails if the globe does not have the image layer.
  [[nodiscard]] Result<LayerTime> layer_time(LayerId imagery) const;
  /// Returns the latest 64 instants that set_layer_time() found missing, in order of time of the finding.
  [[nodiscard]] const std::deque<MissingInstant>& missing_instants() const;
  /// Sets the attribution text of a layer, which replaces the text of its source. Object layers have no text by
  /// default. Empty: no attribution.
  Status set_attribution(LayerId layer, std::string text);
  /// Returns the attribution text of a layer. Fails if the globe does not have the layer.
  [[nodiscard]] Result<std::string> attribution(LayerId layer) const;
  /// Returns the attribution texts of the last frame, each text once. They belong to the image layers with a tile in
  /// view, lowest first, to the elevation, and to the visible object layers. A layer that opaque tiles of the layers
  /// over it hide everywhere does not count.
  [[nodiscard]] std::vector<std::string> attributions() const;
  /// Returns the side of the finest texels of the image layers that the last frame showed, in metres along the
  /// equator; none if it showed no imagery.
  [[nodiscard]] std::optional<double> finest_texel_m() const;
  /// Returns the boxes of the objects' labels that the last frame showed; in stereo, in the left eye's picture.
  [[nodiscard]] std::vector<PictureBox> label_boxes() const;
  /// Replaces the elevation; none: the ellipsoid. A Ground returned earlier keeps its heights.
  Status set_elevation(std::optional<ElevationSource> elevation);
  [[nodiscard]] bool has_relief() const;  ///< true if the globe has elevation

  /// The view that the calls of Globe about camera, frames and pixels act on. It lives as long as the globe.
  [[nodiscard]] GlobeView& main_view();
  void set_camera(const Camera& camera);
  [[nodiscard]] const Camera& camera() const;
  [[nodiscard]] const GlobeOptions& options() const;
  void set_unlit(bool unlit);
  void set_surface(const SurfaceLook& surface);
  void set_stereo(const StereoLook& stereo);
  void set_sky(bool on);                       ///< no effect if the globe was made without a sky
  void set_exaggeration(double exaggeration);  ///< factor of the heights, [0, 100]
  /// Sets the time for Sun and sky; none: as in GlobeOptions. Fails outside the almanac's years, and then changes
  /// nothing. set_night_lights() controls the city lights.
  Status set_time(std::optional<UtcTime> time);
  /// Switches GlobeOptions::night_lights on the night side on or off. Lights show only if a time is set. They are on in
  /// a globe made with a time. No effect without a sky, without such lights, or on another body than the Earth.
  Status set_night_lights(bool on);
  [[nodiscard]] bool has_night_lights() const;  ///< true if city lights are drawn at a time
  /// Sets the budget from the next frame on. Image layers share the GPU memory evenly. Each layer has room for at least
  /// 16 tiles. FrameStats::gpu_bytes_granted is what the driver gives.
  void set_budget(const GlobeBudget& budget);

  /// Draws one frame into `framebuffer`, with its lower left corner at `corner_px`, [-1e6, 1e6]. `framebuffer` is a GL
  /// name, 0 the window; it may be sRGB or not. Uploads arrived tiles within the budget. Returns the frame's
  /// statistics. Draws nothing if status() is an error: the framebuffer is absent, incomplete or without colours; the
  /// viewport is empty or beyond the driver's limits; there is no memory for it; textures have not as many samples; a
  /// setting was refused.
  FrameStats render(unsigned framebuffer, Viewport viewport, glm::ivec2 corner_px = {0, 0});
  [[nodiscard]] const FrameStats& last_frame() const;  ///< counts of the last frame
  /// The error of the last frame, or of a setting that was refused since then. A frame draws nothing if it cannot make
  /// a shader program that no earlier frame needed. The next frame tries again.
  [[nodiscard]] const Status& status() const;

  /// Sets a callback that draws for the application inside each frame, once for each stage and eye; empty: none. It
  /// draws into the bound framebuffer, in the set viewport. Depth test, culling and colour mask are set as for the
  /// globe's own passes. No sampler and no vertex array is bound. It may leave any state but the stencil's. Vertices go
  /// through `matrices`, or through the functions of render/caller_glsl.h, which stay exact near the ground. It must
  /// not call the globe.
  void on_draw(std::function<void(DrawStage stage, const FrameMatrices& matrices)> draw);
  /// Returns the GL name of the texture with the depth of the last frame, in the format of `GlobeOptions::depth`, 0
  /// before the first; rows from the bottom. Valid until the next frame of any view of the globe.
  [[nodiscard]] unsigned depth_texture() const;
  /// Copies the depth of the last frame to a framebuffer with depth, to each sample of a multisampled one. The
  /// application can then draw there behind and before the globe. Call it before another view of the globe draws: views
  /// of equal size share their targets. Fails if another view has drawn since, or if its shader does not compile.
  Status copy_depth(unsigned framebuffer, glm::ivec2 corner_px = {0, 0});

  /// True if the last frame showed everything that its view needs.
  [[nodiscard]] bool settled() const;
  /// Sets a callback for the end of each frame with which the globe becomes settled; empty: none. The callback must not
  /// destroy the globe.
  void on_settled(std::function<void()> told);
  /// False if another frame would be the same as the last one: nothing was set, and nothing has arrived. Costs a few
  /// comparisons. A settled globe changes by itself only when it retries a source.
  [[nodiscard]] bool needs_frame() const;
  /// The same for this framebuffer and viewport: also true if the last frame had another framebuffer or viewport.
  [[nodiscard]] bool needs_frame(unsigned framebuffer, Viewport viewport) const;
  /// Waits until a frame would be settled, and draws that frame. At the deadline draws the present state and returns
  /// false. Returns false at once if status() is an error.
  bool render_until_settled(unsigned framebuffer, Viewport viewport, std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] LoaderCounts loading() const;  ///< sum over all image layers
  /// Returns the missing tiles of imagery: the latest 64 that failed, in order of time. Tiles that failed for now
  /// (MissingKind::failed) are retried after GlobeOptions::retry_after, if they are still wanted.
  [[nodiscard]] const std::deque<MissingTile>& missing_tiles() const;
  /// The same for elevation. Coarser heights, or the ellipsoid, are drawn instead of these tiles.
  [[nodiscard]] const std::deque<MissingTile>& missing_heights() const;

  /// Returns the areas of an object layer that are drawn without their fill, as far as they are cut; none if there is
  /// no such layer.
  [[nodiscard]] std::vector<MissingFill> missing_fills(LayerId layer) const;

  /// Returns the place, layers and object that a pixel of the mono picture shows (geo/coordinates.h); nothing if a
  /// value is out of range.
  [[nodiscard]] GlobePick pick(glm::dvec2 pixel_px, Viewport viewport) const;
  /// Returns the value at a place of a layer of numbers, from the nearest texel of the finest loaded tile; none if no
  /// tile is loaded there. Exact for numbers that a float holds exactly, if `level` is the source's finest. Waits for
  /// the GPU. Fails if `imagery` is not a layer of numbers.
  [[nodiscard]] Result<std::optional<LayerValue>> value_at(LayerId imagery, const Geodetic& place) const;
  /// Asks the layer's source for the value that it stores at a place (TileSource::value_at()), on another thread. The
  /// answer does not depend on the picture. The future's destructor waits for the answer, which takes milliseconds.
  [[nodiscard]] std::future<Result<double, TileFailure>> stored_value(LayerId imagery, const Geodetic& place) const;
  /// Returns the pixel position of a place at its height; nothing if the place is outside the picture, behind the eye
  /// or hidden by the ground.
  [[nodiscard]] std::optional<glm::dvec2> project(const Geodetic& place, Viewport viewport) const;
  /// Returns the camera's view for a picture size, as the functions for picking and projecting take it: geo/camera.h
  /// for the ellipsoid, view/ground.h for the ground. Sides below 1 count as 1.
  [[nodiscard]] View view(Viewport viewport) const;
  /// Returns the ground as it is drawn. The value stays valid after the globe or its elevation is gone.
  [[nodiscard]] Ground ground() const;
  /// Height of the drawn ground over the ellipsoid, exaggerated, from the loaded heights; 0 without any.
  [[nodiscard]] double ground_height_m(Angle lat, Angle lon) const;
  /// The same without exaggeration; nothing without heights.
  [[nodiscard]] std::optional<double> elevation_m(Angle lat, Angle lon) const;

 private:
  friend struct Experiments;  // settings for tests and benchmarks, in a header that is not installed
  friend class GlobeView;
  struct Impl;
  [[nodiscard]] static Result<std::unique_ptr<Globe>> make(const GlobeOptions& options,
                                                           const std::optional<ElevationSource>& elevation);
  explicit Globe(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrella
