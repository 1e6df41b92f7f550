#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands/raster_facts.h"
#include "apps/open_scene/bounds_view.h"
#include "apps/open_scene/listed_features.h"
#include "apps/open_scene/options/scene_options.h"
#include "apps/open_scene/scene_numbers.h"
#include "apps/viewer/clusters/layer_clusters.h"
#include "apps/viewer/styles/layer_style.h"
#include "geo/coordinates.h"
#include "geo/objects.h"
#include "surface/layers.h"

namespace terrella {

enum class LayerKind { imagery, objects, heights };

/// One row of the layer panel.
struct LayerRow {
  LayerId id = LayerId::none;  ///< none for heights
  LayerKind kind = LayerKind::imagery;
  unsigned key = 0;  ///< stays the same when a removed layer returns under another id
  std::string name = {};
  std::shared_ptr<TileSource> tiles = {};   ///< imagery only
  SourceOptions source = {};                ///< source of imagery and heights; no address: the included Earth
  ObjectsOption objects = {};               ///< file and style of objects
  std::optional<GeoRect> bounds = {};       ///< set if known and smaller than the planet
  int finest_level = 0;                     ///< imagery only
  std::optional<NumberFacts> numbers = {};  ///< set for imagery of numbers
  std::string attribution = {};             ///< may be empty
  std::string problem = {};                 ///< last failure of a tile, while tiles are missing
  std::string follow_fault = {};            ///< fault of the last frame, which could not adapt the layer to the view
  ImageLook look = {};                      ///< objects use `shown` and opacity, heights use `shown`
  FactsReader read_facts = {};              ///< reads the facts of a raster; empty for other layers
  std::shared_future<std::vector<std::string>> facts = {};          ///< begun when the row is first open
  bool fills_checked = false;                                       ///< objects: areas without a fill are reported
  std::shared_ptr<LayerStyle> style = {};                           ///< set for objects with features
  std::shared_ptr<const std::vector<ListedFeature>> features = {};  ///< set for objects; may be empty
  std::shared_ptr<LayerClusters> clusters = {};                     ///< set for objects with points
  bool facts_drawn = false;                                         ///< the panel was drawn since they came

  /// Takes the points of objects, if there are any, for clusters.
  void take_points(std::vector<ClusterPoint> points) {
    if (!points.empty()) clusters = std::make_shared<LayerClusters>(std::move(points));
  }
  [[nodiscard]] bool has_facts() const {
    return facts.valid() && facts.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
};

enum class LayerAsk { none, raise, lower, remove, look_at, list, keep, open, undo, redo };
/// User's request that is not stored in `rows`.
struct LayerWish {
  LayerAsk ask = LayerAsk::none;
  std::size_t row = 0;
};

/// A row that only switches something on and off.
struct LayerSwitch {
  const char* name;
  const char* tip;
  bool& on;
};

/// Draws the panel at the right edge, between Ui::begin_frame() and Ui::end_frame(). The switches come first, then the
/// highest layer, which is the last row. `foot` units at the lower edge stay free. `just_opened` gives the panel the
/// keyboard. Stores the user's changes to looks and switches. thread: main
[[nodiscard]] LayerWish draw_layers(const char* title, std::vector<LayerRow>& rows,
                                    const std::vector<LayerSwitch>& switches, float foot, bool just_opened);

}  // namespace terrella
