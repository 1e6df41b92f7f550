#pragma once

#include <CLI/App.hpp>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/options/number_options.h"
#include "geo/body.h"
#include "geo/camera.h"
#include "globe/globe.h"
#include "streaming/georeference/place_words.h"
#include "streaming/remote/remote_options.h"
#include "streaming/url.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_source.h"

namespace terrella {

class GrowingCut;
struct OpenedRasters;

/// Value of one --overlay.
struct OverlayOption {
  Url tile_set;
  double opacity = 1.0;
};

/// Options shared by `view` and `render`; the parse has checked every value.
struct SceneOptions {
  Url tile_set;                  ///< empty: the included Earth
  std::optional<Camera> camera;  ///< absent: the whole globe, see first_camera()
  Viewport size{.width_px = 1024, .height_px = 1024};
  std::optional<Body> body;                      ///< absent: the tile set's body, else Earth
  std::optional<Projection> projection;          ///< absent: as the tile set states
  std::optional<LatitudeKind> latitude;          ///< absent: as the tile set states
  PlaceWords place;                              ///< place of TILESET, if it is a picture
  NumberOptions numbers;                         ///< numbers of TILESET; those of the overlays if TILESET is empty
  std::vector<OverlayOption> overlays;           ///< above the tile set, lowest first
  std::optional<Projection> overlay_projection;  ///< absent: as each overlay states
  bool unlit = false;
  Texturing texturing = Texturing::automatic;
  double paper_a = 4.0;
  double band = 0.05;
  bool squeezed_rows = true;
  int polar_columns = 32;
  double texels_per_pixel = 1.0;
  DepthMode depth = DepthMode::reversed;
  Url elevation;                                 ///< tile set of heights; empty: none
  std::optional<NumberInfo> elevation_encoding;  ///< coding of heights in colours; absent: as the tiles state
  double exaggeration = 1.0;                     ///< factor for heights
  Url night;                                     ///< tile set for the night side; empty: none
  OverlayOption clouds;                          ///< top layer; brightness is alpha; empty: none
  double cloud_height_m = 0.0;                   ///< height of the clouds over the ground
  SurfaceLook surface;
  StereoLook stereo;
  std::string objects;               ///< GeoJSON file; empty: none
  std::optional<bool> map;           ///< --map; absent: the command's default
  std::string places;                ///< GeoJSON file of names, for map and search; empty: the Earth's cities
  bool sky = true;                   ///< stars, Sun, Moon and atmosphere
  std::optional<UtcTime> time;       ///< time of the sky
  std::string cache;                 ///< value of --cache; empty: the default file; "off": none
  std::size_t cache_size_mb = 4096;  ///< limit of the cache's file, in 10^6 bytes
  double timeout_s = 600.0;     ///< longest wait for the descriptions of a remote input, and for the tiles of a picture
  std::size_t memory_mb = 512;  ///< limit for decoded tiles, in 2^20 bytes
  bool offline = false;         ///< use the cache only
  RemoteOptions remote;         ///< options of a remote TILESET
  /// Receives the cuts that go on in the background; null: a picture is cut before it shows.
  std::vector<std::shared_ptr<GrowingCut>>* cuts = nullptr;
  OpenedRasters* opened = nullptr;  ///< receives rasters that are read in place; may be null
};

/// Largest side of a picture or window, pixels.
inline constexpr int kMaxSide_px = 16384;

/// Adds TILESET and the options to a subcommand; `options` must outlive the parse. thread: main
void add_scene_options(CLI::App& command, SceneOptions& options);

/// Options for another source of the scene than TILESET. The statements about TILESET and the options of its server do
/// not apply. A cache holds the tiles of one source, so the other source's cache is the default one. thread: any
[[nodiscard]] SceneOptions options_beside(const SceneOptions& options, const Url& tile_set);

/// Returns --body, else the tile set's body, else Earth. Fails if the tile set names an invalid body.
[[nodiscard]] Result<Body> scene_body(const SceneOptions& options, const TileSetInfo& info);

/// Returns --camera, else a view straight down on the imagery, if its data are in a part of the planet, else one on
/// 20°N 0°E with the whole globe filling the picture.
[[nodiscard]] Camera first_camera(const SceneOptions& options, const Body& body, const GeoRect& bounds,
                                  Viewport picture);

/// Converts the options for the globe. thread: any
[[nodiscard]] GlobeOptions globe_options(const SceneOptions& options, const Body& body);
/// Says what the driver gives for tiles, if that is less than --memory asks for, or if it refused memory; else empty.
/// thread: any
[[nodiscard]] std::string memory_note(const SceneOptions& options, const FrameStats& stats);
/// Sets --paper-a and --band, which GlobeOptions does not have. thread: main
void set_paper_texturing(Globe& globe, const SceneOptions& options);

}  // namespace terrella
