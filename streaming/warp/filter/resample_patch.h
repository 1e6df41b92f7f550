#pragma once

#include "streaming/warp/canvas.h"
#include "streaming/warp/map/patch.h"

namespace terrella {

/// Fills the pixels of a patch from a canvas that contains all that its filter reaches. thread: any
template <class Tile>
void resample_patch(const Patch& patch, const RasterArea& area, const Canvas<Tile::kChannels>& canvas,
                    typename Tile::Pixels& to);

}  // namespace terrella
