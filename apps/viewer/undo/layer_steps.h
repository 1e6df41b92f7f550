#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/viewer/panels/layer_panel.h"
#include "apps/viewer/styles/layer_style.h"
#include "apps/viewer/undo/undo_steps.h"
#include "tiles/elevation_source.h"

// thread: main, for all of this header
namespace terrella {

/// Values of a layer that the user can change in its row.
struct LayerState {
  unsigned key = 0;  ///< key of the row
  std::string name = {};
  ImageLook look = {};
  std::string colormap = {};                    ///< for numbers
  std::optional<LayerStyle::Drawn> style = {};  ///< for objects with a style
  double cluster_px = 0.0;                      ///< for objects
  [[nodiscard]] bool operator==(const LayerState& other) const;
};

[[nodiscard]] LayerState state_of(const LayerRow& row);

/// Looks before and after a step, in the same order of layers.
struct LookStep {
  std::vector<LayerState> before, after;
};

/// A move by one place.
struct MoveStep {
  unsigned key = 0;
  std::string name;
  bool up = false;
};

/// A removed layer.
struct RemoveStep {
  LayerRow row;
  std::size_t place = 0;                        ///< number of layers of its kind under it
  std::shared_ptr<TileSource> shown = {};       ///< for imagery: the tiles of the date that it showed
  std::optional<ElevationSource> heights = {};  ///< for heights
  std::optional<LayerStyle::Drawn> style = {};  ///< for objects with a style
};

using LayerStep = std::variant<LookStep, MoveStep, RemoveStep>;

/// The steps of the layers, and the looks after the last one.
struct LayerSteps {
  UndoSteps<LayerStep> steps = {};
  std::vector<LayerState> seen = {};
  unsigned last_key = 0;
};

/// Returns the step between two looks of the layers; nullopt without a change. Layers that came or went do not count.
[[nodiscard]] std::optional<LookStep> step_between(const std::vector<LayerState>& before,
                                                   const std::vector<LayerState>& after);

/// The step in words: "look of hills.tif".
[[nodiscard]] std::string step_text(const LayerStep& step);

}  // namespace terrella
