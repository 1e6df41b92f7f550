#pragma once

#include "geo/camera.h"
#include "render/gl/frame_block.h"

namespace terrella {

/// Returns the frame block with the fields of one eye: its place, its axes, the shape of the picture and the depth
/// range, metres. Sizes in pixels are as given; all other fields are zero. thread: any
[[nodiscard]] FrameBlock frame_of_camera(const View& view, double near_m, double far_m);

}  // namespace terrella
