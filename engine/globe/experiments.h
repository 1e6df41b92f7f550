#pragma once

#include <chrono>
#include <optional>

#include "geo/cube_sphere.h"
#include "globe/globe.h"

namespace terrella {

/// Settings of a globe for comparisons in tests and benchmarks. No application needs them, so this header is not
/// installed. Paper 1 is A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in
/// geoinformation and cartographic systems", 2023. Paper 2 is "Interactive visualization of 3D data on a virtual globe
/// in stereoscopic systems", abstract of a dissertation, chapter 2.2 (engine/DESIGN.md). thread: main
struct Experiments {
  double paper_a = 4.0;  ///< exponent a of paper 1's formula (6) for Texturing::paper, [2, 8]
  /// Width b of paper 1's pole bands, formula (5), for Texturing::paper: a fraction of the picture's height, (0, 0.5].
  double paper_band = 0.05;
  /// Draws in the order of an opaque globe with blending switched on. The picture then has the artefacts that paper 2
  /// prevents.
  bool naive_translucency = false;
  bool layers_one_by_one = false;           ///< draws each image layer in a pass of its own
  std::optional<unsigned> patch_shuffle{};  ///< seed of a random order of the patches; none: the normal order
  /// Mapping from the cube to the sphere. It holds for layers added later, so set it before the first layer.
  CubeMapping mapping = CubeMapping::tangent;

  /// Returns the settings of a globe. A change holds from the next frame on.
  [[nodiscard]] static Experiments& of(Globe& globe);

  /// Pixels of the picture for each pixel of a size, [1, 4]: of stars, markers, lines, texts, and pictures of the
  /// ground. A picture that is drawn larger and then averaged thus has symbols of their usual size.
  double pixel_scale = 1.0;
  /// Time that layers follow (LayerClock) instead of the globe's: that of a whole frame, while the Sun moves within it.
  std::optional<UtcTime> layer_clock{};

  // For films. A settled picture depends on the tiles of earlier views: heights are taken from the finest loaded tile,
  // and a texture continues in the loaded neighbours of its tile. These two make a picture depend on its view alone.
  /// Forgets all tiles of imagery and pictures of the ground, as if the globe were new. Globe::set_elevation() does the
  /// same for heights.
  static void forget_imagery(Globe& globe);
  /// Waits until the heights of the main view are loaded, and draws nothing. Imagery that only coarser heights want is
  /// thus not requested. False at the deadline, or if Globe::status() is an error.
  static bool settle_heights(Globe& globe, unsigned framebuffer, Viewport viewport,
                             std::chrono::steady_clock::time_point deadline);
};

}  // namespace terrella
