#include "apps/bench/shots.h"

#include <chrono>
#include <stdexcept>

namespace terrella::bench {

Camera as_globe_camera(const truth::TruthCamera& c) {
  return {
      .eye = {.lat = Angle::degrees(c.eye.lat_deg), .lon = Angle::degrees(c.eye.lon_deg), .height_m = c.eye.height_m},
      .heading = Angle::degrees(c.heading_deg),
      .pitch = Angle::degrees(c.pitch_deg),
      .fov_y = Angle::degrees(c.fov_deg)};
}

truth::TruthCamera as_truth_camera(const Camera& c) {
  return {.eye = {c.eye.lat.deg(), c.eye.lon.deg(), c.eye.height_m},
          .heading_deg = c.heading.deg(),
          .pitch_deg = c.pitch.deg(),
          .fov_deg = c.fov_y.deg()};
}

truth::Spheroid as_spheroid(const Ellipsoid& ellipsoid) {
  return {ellipsoid.a_m(), 1.0 - ellipsoid.b_m() / ellipsoid.a_m()};
}

truth::Picture shot(const OffscreenTarget& target, Viewport size) {
  const std::vector<std::uint8_t> rgba = target.read();
  truth::Picture picture{size.width_px, size.height_px, {}};
  picture.rgb.reserve(rgba.size() / 4 * 3);
  for (std::size_t k = 0; k < rgba.size(); k += 4) {
    picture.rgb.insert(picture.rgb.end(), {rgba[k], rgba[k + 1], rgba[k + 2]});
  }
  return picture;
}

FrameStats settle(Globe& globe, const truth::TruthCamera& camera, const OffscreenTarget& target, Viewport size) {
  globe.set_camera(as_globe_camera(camera));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  if (!globe.render_until_settled(target.framebuffer(), size, deadline)) {
    throw std::runtime_error(globe.status() ? "a view has not settled after two minutes; is the disk that slow?"
                                            : globe.status().error().message);
  }
  return globe.render(target.framebuffer(), size);
}

}  // namespace terrella::bench
