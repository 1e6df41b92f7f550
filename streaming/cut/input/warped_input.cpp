#include "streaming/cut/input/warped_input.h"

#include <fmt/format.h>

namespace terrella {

Result<WarpedInput> open_warped(const PictureFile& picture, const CrsPlace& from,
                                const std::optional<HeightPlan>& heights) {
  (void)heights;
  return Error{fmt::format("{}: resampling from {} is not there yet", picture.path.string(), from.crs)};
}

}  // namespace terrella
