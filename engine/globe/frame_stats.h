#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "geo/coordinates.h"
#include "objects/object_pick.h"
#include "objects/object_shapes.h"
#include "surface/layers.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Statistics of one frame.
struct FrameStats {
  int patches = 0;
  int band_patches = 0;  ///< those among `patches` drawn by a per-fragment program
  int draw_calls = 0;
  long triangles = 0;
  int tiles_wanted = 0;        ///< tiles that the view needs at full quality
  int tiles_pending = 0;       ///< those wanted tiles that are neither on the GPU nor finally failed
  int tiles_missing = 0;       ///< those wanted tiles that finally failed
  int patches_uncovered = 0;   ///< patches with a cell without any imagery; 0 once the root tiles are loaded
  bool imagery_shown = false;  ///< a tile of imagery is in view, even if only a coarser fallback
  std::size_t uploaded_bytes = 0;
  std::size_t objects_cut = 0;  ///< lines and areas tessellated since the previous frame
  int heights_pending = 0;      ///< elevation tiles that the view needs and that have neither arrived nor failed
  int heights_missing = 0;      ///< failed elevation tiles among those that recent views needed
  /// Heights arrived after this frame was drawn: another frame will show the newer ground.
  bool heights_arrived = false;
  int relief_meshes = 0;   ///< patches whose relief was rebuilt
  int relief_put_off = 0;  ///< patches drawn coarser than their relief needs, for now
  /// The air is that of an eye or a Sun nearby, because they have just moved: another frame shows the exact air.
  bool air_put_off = false;
  double selection_ms = 0.0;
  // Totals over all layers that were drawn.
  std::size_t gpu_bytes = 0;  ///< texture slots, used or free
  /// Most bytes that texture slots may take. Less than GlobeOptions::gpu_bytes if the driver's array textures hold no
  /// more (65,536 tiles at most), or if the driver has refused memory; the globe then goes on with fewer tiles. At
  /// least 16 tiles for each layer.
  std::size_t gpu_bytes_granted = 0;
  /// The driver has refused memory for texture slots, for pictures of the ground, or for an object layer, which is
  /// then not drawn.
  bool gpu_memory_refused = false;
  /// Squares of the ground in view whose lines and areas are not drawn, because their pictures have no room: too small
  /// a budget for the coarsest pictures.
  int ground_left_out = 0;
  /// Letters of labels that neither the labels' font nor a font of the system has, so far, in ascending order. They are
  /// drawn as replacement marks.
  std::u32string without_font = {};
  std::size_t height_bytes = 0;  ///< elevation tiles
  std::size_t patches_held = 0;  ///< patches kept in memory, drawn or not
  std::size_t tiles_known = 0;   ///< tiles of imagery with a remembered state
};

/// A rectangle of a picture, pixels from the upper left corner.
struct PictureBox {
  glm::vec2 low_px, high_px;
};

/// A missing tile, and the reason.
struct MissingTile {
  TileId id;
  TileFailure failure;
  LayerId layer = LayerId::none;  ///< the image layer of the tile
};

/// The objects and layers under a pixel.
struct GlobePick {
  std::optional<Geodetic> place{};       ///< place on the ground (view/ground.h); none beside the globe
  LayerId imagery = LayerId::none;       ///< the top image layer drawn there, according to its bounds
  LayerId objects = LayerId::none;       ///< layer of the object; none: no object
  std::optional<PickedObject> object{};  ///< its feature, and its kind and index in the layer's lists
};

/// A value of a number layer at a place.
struct LayerValue {
  double value = 0.0;  ///< in the unit of the layer's numbers, after scale and offset; NaN: no data
  int level = 0;       ///< level of the tile that the value was read from
};

}  // namespace terrella
