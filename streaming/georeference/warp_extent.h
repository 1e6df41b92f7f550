#pragma once

#include <optional>

#include "streaming/georeference/crs.h"
#include "streaming/georeference/gdal_advice.h"

namespace terrella {

/// The grid of longitudes and latitudes that holds a picture of any projection, with pixels of about its own size in
/// the middle. None if too little of the picture has a place. thread: any
[[nodiscard]] std::optional<DegreeGrid> warp_extent(const PictureFile& picture, const Georeference& said,
                                                    const Crs& crs);

}  // namespace terrella
