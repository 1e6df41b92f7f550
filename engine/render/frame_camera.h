#pragma once

#include "geo/camera.h"
#include "render/gl/frame_block.h"

namespace terrella {

/// The frame's block with what it has of an eye: its place, its axes, the picture's shape and the depths between which
/// it draws, metres; the rest is zero. thread: any
[[nodiscard]] FrameBlock frame_of_camera(const View& view, double near_m, double far_m);

}  // namespace terrella
