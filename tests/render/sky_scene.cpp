#include "sky_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/frame_camera.h"

namespace terrella::test {

SkyScene::SkyScene(const Body& body, Viewport size, const std::vector<Star>& stars) : body_(body), size_(size) {
  auto context = HeadlessContext::create();
  if (!context) throw std::runtime_error(context.error().message);
  context_ = std::move(*context);
  sky_ = std::make_unique<SkyPass>(body, stars);
  sky_->keep_air_in(air_);
  color_ = gl::make_texture(GL_TEXTURE_2D);
  depth_ = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(color_.name(), 1, GL_RGBA8, size.width_px, size.height_px);
  glTextureStorage2D(depth_.name(), 1, GL_DEPTH32F_STENCIL8, size.width_px, size.height_px);
  framebuffer_ = gl::make_framebuffer();
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
  glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_STENCIL_ATTACHMENT, depth_.name(), 0);
  frame_ = gl::make_buffer();
  glNamedBufferStorage(frame_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
}

void SkyScene::upload_frame(const View& view) const {
  const FrameBlock block = frame_of_camera(view, 1.0, 10.0);
  glNamedBufferSubData(frame_.name(), 0, sizeof(block), &block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.name());
}

// Row by row the first and the last pixel of the globe, which is convex.
void SkyScene::mask_globe(const View& view) {
  glEnable(GL_SCISSOR_TEST);
  glClearStencil(1);
  for (int y = 0; y < size_.height_px; ++y) {
    int first = size_.width_px, last = -1;
    for (int x = 0; x < size_.width_px; ++x) {
      if (!pick(view, body_.ellipsoid, {x + 0.5, y + 0.5})) continue;
      first = std::min(first, x);
      last = x;
    }
    if (last < 0) continue;
    glScissor(first, size_.height_px - 1 - y, last - first + 1, 1);
    glClear(GL_STENCIL_BUFFER_BIT);
  }
  glDisable(GL_SCISSOR_TEST);
}

std::vector<std::uint8_t> SkyScene::draw(const Camera& camera, const SkyInput& input) {
  const View at = view(camera);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, size_.width_px, size_.height_px);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  apply({});
  glClearColor(0, 0, 0, 1);
  glClearDepth(kDepth);
  glClearStencil(0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  mask_globe(at);
  upload_frame(at);
  if (const Status made = sky_->prepare(at, input); !made) throw std::runtime_error(made.error().message);
  draw_calls_ = sky_->draw(at, input, {.stencil = StencilState{.reference = 0, .read_mask = 1}});
  const auto width = static_cast<std::size_t>(size_.width_px) * 4, height = static_cast<std::size_t>(size_.height_px);
  std::vector<std::uint8_t> rows(width * height), picture(width * height);
  glReadPixels(0, 0, size_.width_px, size_.height_px, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
  for (std::size_t y = 0; y < height; ++y) {
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(y * width), width,
                picture.begin() + static_cast<std::ptrdiff_t>((height - 1 - y) * width));
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  return picture;
}

std::vector<float> SkyScene::depth() const {
  std::vector<float> all(static_cast<std::size_t>(size_.width_px) * static_cast<std::size_t>(size_.height_px));
  glReadPixels(0, 0, size_.width_px, size_.height_px, GL_DEPTH_COMPONENT, GL_FLOAT, all.data());
  return all;
}

SkyInput sky_at(std::string_view utc) {
  const auto time = parse_utc(utc);
  EXPECT_TRUE(time) << utc;
  const auto almanac = almanac_at(*time);
  EXPECT_TRUE(almanac) << utc;
  return {.almanac = *almanac};
}

}  // namespace terrella::test
