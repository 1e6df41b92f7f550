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
  LayerBlend blend = LayerBlend::normal;
};

/// An image layer of a project.
struct LayerOption {
  SourceOptions source;  ///< statements about the source; an empty address: the included Earth
  ImageLook look;        ///< `numbers` follow from the numbers of `source`
};

/// An object layer of a project.
struct ObjectsOption {
  std::string file;                       ///< GeoJSON, a vector file of GDAL's, or a glTF model
  std::string style{};                    ///< JSON file of a style; empty: the objects' own properties
  std::string style_over{};               ///< JSON of the style that the window gave them; empty: none
  std::optional<Geodetic> model_place{};  ///< set for a model: where it stands
  bool shown = true;
  double opacity = 1.0;     ///< [0, 1]
  double cluster_px = 0.0;  ///< radius of clusters of points (globe/features/point_clusters.h); 0: none
};

/// Options shared by `view` and `render`; the parse has checked every value.
struct SceneOptions {
  SourceOptions base;                 ///< TILESET; its numbers are those of the overlays if it is the included Earth
  ImageLook base_look{};              ///< look of `base` in a project; `numbers` follow from `base`
  std::vector<LayerOption> layers{};  ///< images of a project, above all others, lowest first
  std::vector<ObjectsOption> object_layers{};  ///< objects of a project, lowest first, above `objects`
  std::string drawings{};                      ///< GeoJSON of the user's marks in a project; empty: none
  bool elevation_shown = true;                 ///< false: the heights are opened, but not drawn
  bool leave_out_faulty = false;               ///< leave out layers that cannot be opened, and report them
  std::string project{};                       ///< file of the project; empty: none
  std::optional<Error> project_fault{};        ///< fault of TILESET if it is a project that cannot be read
  std::optional<Camera> camera;                ///< absent: see default_camera()
  Viewport size{.width_px = 1024, .height_px = 1024};
  std::vector<OverlayOption> overlays;           ///< above the tile set, lowest first
  std::optional<Projection> overlay_projection;  ///< absent: as each overlay states
  LayerBlend overlay_blend = LayerBlend::normal;
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
  bool keep_features = false;               ///< keep the features of the objects, for other styles
  std::string objects;                      ///< GeoJSON, or a vector file of GDAL's; empty: none
  std::string object_style;                 ///< JSON file of a style for the objects; empty: their own properties
  double cluster_px = 0.0;                  ///< radius of clusters of the points of `objects`; 0: none
  std::optional<bool> map;                  ///< --map; absent: the command's default
  std::optional<bool> graticule;            ///< absent: the command's default
  std::string places;                       ///< GeoJSON file of names, for map and search; empty: the Earth's cities
  bool sky = true;                          ///< stars, Sun, Moon and atmosphere
  std::optional<UtcTime> time;              ///< time of the sky
  std::optional<LayerClock> layer_clock{};  ///< clock of all image layers; absent: that of their looks
  bool night_lights = true;                 ///< lights of the Earth's cities on the night side at `time`
  std::size_t memory_mb = 512;              ///< limit for decoded tiles, in 2^20 bytes

  [[nodiscard]] bool has_objects() const { return !objects.empty() || !object_layers.empty() || !drawings.empty(); }
};

/// Makes these the images of a project, lowest first: the lowest one is `base`. Without any, `base` is the included
/// Earth, hidden. thread: any
void set_images(SceneOptions& options, std::vector<LayerOption> images);

/// Largest side of a picture or window, pixels.
inline constexpr int kMaxSide_px = 16384;

/// Adds TILESET and the options to a subcommand; `options` must outlive the parse. A TILESET that is a project is read
/// at the end of the parse: options of the command line win over those of the project. thread: main
void add_scene_options(CLI::App& command, SceneOptions& options);
/// Adds --projection and --latitude, the meaning of an image's rows. thread: main
void add_row_options(CLI::App& command, SourceOptions& source);

/// Address of the heights of the Earth that the program includes. Throws BrokenInstallation. thread: any
[[nodiscard]] Url included_relief();
/// thread: any
[[nodiscard]] bool is_included_relief(const Url& heights);

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
