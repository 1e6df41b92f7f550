#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geo/body.h"
#include "render/gl/frame_block.h"
#include "render/objects/object_pass.h"
#include "tests/gl/gl_context_test.h"

namespace terrella::test {

[[nodiscard]] inline Geodetic at(double lat_deg, double lon_deg, double height_m = 0.0) {
  return {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = height_m};
}
/// A camera over a place.
[[nodiscard]] inline Camera over(double lat_deg, double lon_deg, double height_m, double pitch_deg = -90.0,
                                 double heading_deg = 0.0) {
  Camera camera;
  camera.eye = at(lat_deg, lon_deg, height_m);
  camera.pitch = Angle::degrees(pitch_deg);
  camera.heading = Angle::degrees(heading_deg);
  return camera;
}

/// A picture of objects alone: RGBA8, rows from the top.
struct ObjectPicture {
  Viewport size;
  std::vector<std::uint8_t> rgba;
  [[nodiscard]] ObjectColor at(int x, int y) const {
    const std::size_t k =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width_px) + static_cast<std::size_t>(x));
    return {rgba[k], rgba[k + 1], rgba[k + 2], rgba[k + 3]};
  }
  [[nodiscard]] bool shown(int x, int y) const { return at(x, y).alpha > 127; }
};

/// Draws objects on nothing: a transparent picture with depth, without a planet.
class ObjectCanvas : public GlContextTest {
 protected:
  void SetUp() override;
  void TearDown() override;

  void use(DepthMode depth, Viewport size);
  /// Draws both parts of a scene, unlit.
  ObjectPicture draw(const ObjectScene& scene, const Camera& camera) { return draw(scene, view(camera)); }
  ObjectPicture draw(const ObjectScene& scene, const View& view);
  [[nodiscard]] View view(const Camera& camera) const { return make_view(camera, ellipsoid_, size_); }
  [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }

  std::vector<std::byte> font_;  ///< for use()
  LabelSight label_sight_;
  ShownLabels shown_labels_;  ///< labels of the last picture
  int draw_calls_ = 0;        ///< draw calls of the last picture
  bool lit_ = false;
  double hiding_radius_m_ = 0.0;

 private:
  FrameBlock upload_frame(const View& view) const;

  std::unique_ptr<ObjectPass> pass_;
  DepthMode depth_mode_ = DepthMode::reversed;
  Ellipsoid ellipsoid_ = earth().ellipsoid;
  Viewport size_{0, 0};
  gl::Texture color_, depth_;
  gl::Framebuffer framebuffer_;
  gl::Buffer frame_block_;
};

}  // namespace terrella::test
