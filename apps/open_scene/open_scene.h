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
};

/// A globe with the layers that the options of a scene name.
struct OpenedScene {
  Body body = earth();
  TileSetInfo base{};                        ///< description of TILESET
  std::vector<SceneLayer> images{};          ///< lowest first
  std::optional<ElevationSource> heights{};  ///< none without --elevation
  SceneObjects objects{};                    ///< messages have named the faults of --objects
  std::unique_ptr<Globe> globe{};
};

/// Returns the globe's options when its body is known. An OpenGL context is current afterwards.
using PrepareGlobe = std::function<Result<GlobeOptions>(const Body& body)>;

/// Opens all that the options name: TILESET, heights, overlays, night, clouds and objects. The error names the input.
/// Throws CLI::ValidationError if the eye is out of range, and BrokenInstallation. thread: main
[[nodiscard]] Result<OpenedScene> open_scene(SceneOptions options, const PrepareGlobe& prepare);

/// Adds a layer of imagery or numbers on top of a globe that open_scene() has made of these options. The error names
/// the overlay. Throws BrokenInstallation. thread: main
[[nodiscard]] Result<SceneLayer> add_overlay(Globe& globe, const SceneOptions& options, const OverlayOption& overlay);

}  // namespace terrella
