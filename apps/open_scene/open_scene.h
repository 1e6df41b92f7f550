#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "apps/open_scene/options/scene_options.h"
#include "apps/open_scene/scene_numbers.h"
#include "apps/open_scene/scene_objects.h"
#include "base/result.h"
#include "globe/globe.h"

namespace terrella {

/// An image layer of an opened scene.
struct SceneLayer {
  LayerId id = LayerId::none;
  Url address{};                         ///< empty: the included Earth
  std::optional<NumberFacts> numbers{};  ///< set if the layer has numbers
  SourceOptions source{};                ///< an empty address: the included Earth
  std::shared_ptr<TileSource> tiles{};
};

/// A globe with the layers that the options of a scene name.
struct OpenedScene {
  Body body = earth();
  TileSetInfo base{};                        ///< description of TILESET; none for a globe without pictures
  std::vector<SceneLayer> images{};          ///< lowest first; empty for a globe without pictures
  std::vector<SceneObjects> objects{};       ///< lowest first
  std::optional<ElevationSource> heights{};  ///< none without --elevation
  std::vector<std::string> left_out{};       ///< messages about layers of a project that are left out
  bool all_objects = true;                   ///< false if objects have faults, which messages have named
  std::unique_ptr<Globe> globe{};
};

/// Returns the globe's options when its body is known. An OpenGL context is current afterwards.
using PrepareGlobe = std::function<Result<GlobeOptions>(const Body& body)>;

/// Opens all that the options name: TILESET, heights, overlays, night, clouds, objects, and the layers of a project.
/// The error names the input. Layers of a project that cannot be opened are left out, with a message on standard error;
/// if its lowest image is one of them, the next one takes its place, at last the included Earth. A project without
/// images on another body is a globe without pictures. Throws
/// CLI::ValidationError if the eye is out of range, and BrokenInstallation. thread: main
[[nodiscard]] Result<OpenedScene> open_scene(SceneOptions options, const PrepareGlobe& prepare);

/// Adds a layer of imagery or numbers on top of a globe. The error names the source. Throws BrokenInstallation.
/// thread: main
[[nodiscard]] Result<SceneLayer> add_layer(Globe& globe, const SourceOptions& source, const ImageLook& look);

/// Adds a layer of imagery or numbers on top of a globe that open_scene() has made of these options. The error names
/// the overlay. Throws BrokenInstallation. thread: main
[[nodiscard]] Result<SceneLayer> add_overlay(Globe& globe, const SceneOptions& options, const OverlayOption& overlay);

}  // namespace terrella
