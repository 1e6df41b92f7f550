#pragma once

#include <optional>

#include "streaming/georeference/crs.h"
#include "streaming/georeference/gdal_advice.h"

namespace terrella {

/// Grid of longitudes and latitudes that covers a picture of any projection. Pixels are about as large as those in the
/// middle of the picture. None if too little of the picture has a place. thread: any
[[nodiscard]] std::optional<DegreeGrid> warp_extent(const PictureFile& picture, const Georeference& said,
                                                    const Crs& crs);

}  // namespace terrella
