#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geo/camera.h"
#include "render/gl/gl_handle.h"
#include "render/gl/offscreen.h"
#include "render/sky/sky_pass.h"

namespace terrella::test {

/// The sky alone, drawn as the renderer draws it: the frame's block, a stencil that keeps the globe's pixels out, a
/// depth buffer that must stay as it was.
class SkyScene {
 public:
  /// Fails the test if a GL or a program cannot be had.
  SkyScene(const Body& body, Viewport size, const std::vector<Star>& stars);

  /// The picture, RGBA8, rows from the top, black where the globe is.
  std::vector<std::uint8_t> draw(const Camera& camera, const SkyInput& input);
  [[nodiscard]] int draw_calls() const { return draw_calls_; }
  /// The depth of every pixel after the last draw(), which cleared it to kDepth.
  [[nodiscard]] std::vector<float> depth() const;
  [[nodiscard]] View view(const Camera& camera) const { return make_view(camera, body_.ellipsoid, size_); }

  static constexpr float kDepth = 0.3F;

 private:
  void mask_globe(const View& view);
  void upload_frame(const View& view) const;

  Body body_;
  Viewport size_;
  std::unique_ptr<HeadlessContext> context_;
  std::unique_ptr<SkyPass> sky_;
  std::unique_ptr<AirTextures> air_;
  gl::Texture color_, depth_;
  gl::Framebuffer framebuffer_;
  gl::Buffer frame_;
  int draw_calls_ = 0;
};

/// The sky at an instant, everything on.
[[nodiscard]] SkyInput sky_at(std::string_view utc);

}  // namespace terrella::test
