#pragma once

#include <CLI/App.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "geo/body.h"
#include "geo/camera.h"
#include "globe/globe.h"
#include "streaming/remote/remote_options.h"
#include "streaming/url.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_source.h"

namespace terrella {

/// One --overlay.
struct OverlayOption {
  Url tile_set;
  double opacity = 1.0;
};

/// What `view` and `render` have in common on the command line. Every value has been checked once the parse is over.
struct SceneOptions {
  Url tile_set;                  ///< empty: the Earth that the program carries
  std::optional<Camera> camera;  ///< absent: the whole globe, see first_camera()
  Viewport size{.width_px = 1024, .height_px = 1024};
  std::optional<Body> body;                      ///< absent: what the tile set says, else Earth
  std::optional<Projection> projection;          ///< absent: what the tile set says
  std::optional<LatitudeKind> latitude;          ///< absent: what the tile set says
  std::vector<OverlayOption> overlays;           ///< over the tile set, the lowest first
  std::optional<Projection> overlay_projection;  ///< absent: what they say of themselves
  bool unlit = false;
  Texturing texturing = Texturing::automatic;
  double paper_a = 4.0;
  double band = 0.05;
  bool squeezed_rows = true;
  int polar_columns = 32;
  double texels_per_pixel = 1.0;
  DepthMode depth = DepthMode::reversed;
  Url elevation;              ///< tile set of heights; empty: none
  double exaggeration = 1.0;  ///< of heights
  Url night;                  ///< tile set that shows where it is night; empty: none
  OverlayOption clouds;       ///< whose brightness is its alpha, over the others; empty: none
  SurfaceLook surface;
  StereoLook stereo;
  std::string objects;               ///< GeoJSON file; empty: none
  bool sky = true;                   ///< stars, Sun, Moon and atmosphere
  std::optional<UtcTime> time;       ///< of the sky
  std::string cache;                 ///< --cache as given; empty: the default place; "off": none
  std::size_t cache_size_mb = 4096;  ///< of the cache's file, 10^6 bytes each
  std::size_t memory_mb = 512;       ///< memory for tiles, 2^20 bytes each
  bool offline = false;              ///< the cache alone
  RemoteOptions remote;              ///< what is said about a remote TILESET
};

/// The largest side of a picture or window, pixels.
inline constexpr int kMaxSide_px = 16384;

/// Adds TILESET and the options to a subcommand; `options` must outlive the parse. thread: main
void add_scene_options(CLI::App& command, SceneOptions& options);

/// The body to draw: --body, else what the tile set says of itself, else Earth. Fails if the tile set says nonsense.
[[nodiscard]] Result<Body> scene_body(const SceneOptions& options, const TileSetInfo& info);

/// The camera to start with: --camera, else straight down over 20°N 0°E from where the whole globe fills the picture.
[[nodiscard]] Camera first_camera(const SceneOptions& options, const Body& body, Viewport picture);

/// The options as the globe takes them. thread: any
[[nodiscard]] GlobeOptions globe_options(const SceneOptions& options, const Body& body);

}  // namespace terrella
