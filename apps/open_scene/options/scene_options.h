#pragma once

#include <CLI/App.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/open_scene/options/source_options.h"
#include "geo/camera.h"
#include "globe/globe.h"

namespace terrella {

/// Value of one --overlay.
struct OverlayOption {
  Url tile_set;
  double opacity = 1.0;
};

/// Options shared by `view` and `render`; the parse has checked every value.
struct SceneOptions {
  SourceOptions base;            ///< TILESET; its numbers are those of the overlays if it is the included Earth
  std::optional<Camera> camera;  ///< absent: see default_camera()
  Viewport size{.width_px = 1024, .height_px = 1024};
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
  std::string objects;          ///< GeoJSON, or a vector file of GDAL's; empty: none
  bool keep_features = false;   ///< keep the features of the objects, for other styles
  std::string object_style;     ///< JSON file of a style for the objects; empty: their own properties
  std::optional<bool> map;      ///< --map; absent: the command's default
  std::string places;           ///< GeoJSON file of names, for map and search; empty: the Earth's cities
  bool sky = true;              ///< stars, Sun, Moon and atmosphere
  std::optional<UtcTime> time;  ///< time of the sky
  std::size_t memory_mb = 512;  ///< limit for decoded tiles, in 2^20 bytes
};

/// Largest side of a picture or window, pixels.
inline constexpr int kMaxSide_px = 16384;

/// Adds TILESET and the options to a subcommand; `options` must outlive the parse. thread: main
void add_scene_options(CLI::App& command, SceneOptions& options);

/// Converts the options for the globe. thread: any
[[nodiscard]] GlobeOptions globe_options(const SceneOptions& options, const Body& body);
/// Says what --memory leaves out on the ground, or what the driver gives for tiles, if that is less than --memory asks
/// for, or if it refused memory; else empty. thread: any
[[nodiscard]] std::string memory_note(std::size_t memory_mb, const FrameStats& stats);
/// Names the letters of labels that no font has, and a cure; empty if all have one. thread: any
[[nodiscard]] std::string font_note(const FrameStats& stats);
/// Sets --paper-a and --band, which GlobeOptions does not have. thread: main
void set_paper_texturing(Globe& globe, const SceneOptions& options);

}  // namespace terrella
