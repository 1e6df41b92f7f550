#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geo/coordinates.h"
#include "geo/objects.h"
#include "surface/layers.h"

namespace terrella {

enum class LayerKind { imagery, objects, heights };

/// A layer as the panel has it.
struct LayerRow {
  LayerId id = LayerId::none;  ///< of heights: none
  LayerKind kind = LayerKind::imagery;
  std::string name = {};
  std::optional<GeoRect> bounds = {};  ///< not of the whole planet, and known
  int finest_level = 0;                ///< of imagery
  ImageLook look = {};                 ///< of objects `shown` and opacity count, of heights `shown`
};

enum class LayerAsk { none, raise, lower, remove, look_at };
/// What the person asked for beside what `rows` say.
struct LayerWish {
  LayerAsk ask = LayerAsk::none;
  std::size_t row = 0;
};

inline constexpr const char* kLayersTitle = "Layers, the highest first";

/// The panel, beside the right edge, the highest layer (the last row) first; between Ui::begin_frame() and
/// Ui::end_frame(). `just_opened` gives it the keyboard. Changes looks and the graticule as the person does.
/// thread: main
[[nodiscard]] LayerWish draw_layers(std::vector<LayerRow>& rows, bool& graticule, bool just_opened);

/// Where all of it is; crosses ±180° if that is shorter. Nothing if there is nothing, or it spans most of the planet.
/// thread: any
[[nodiscard]] std::optional<GeoRect> bounds_of(const ObjectScene& scene);
/// The same of bounds that may be the planet's.
[[nodiscard]] std::optional<GeoRect> if_a_part(const GeoRect& bounds);
/// From the west edge to the east edge, (0°, 360°].
[[nodiscard]] Angle width_of(const GeoRect& bounds);

}  // namespace terrella
