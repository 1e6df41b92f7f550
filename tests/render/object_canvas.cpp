#include "object_canvas.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/frame_camera.h"

namespace terrella::test {

void ObjectCanvas::SetUp() {
  GlContextTest::SetUp();
  if (HasFatalFailure()) return;
  frame_block_ = gl::make_buffer();
  glNamedBufferStorage(frame_block_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  use(DepthMode::reversed, {200, 200});
}

void ObjectCanvas::TearDown() {
  pass_.reset();
  color_ = {};
  depth_ = {};
  framebuffer_ = {};
  frame_block_ = {};
  GlContextTest::TearDown();
}

void ObjectCanvas::use(DepthMode depth, Viewport size) {
  auto pass = ObjectPass::create(depth);
  ASSERT_TRUE(pass) << pass.error().message;
  pass_ = std::move(*pass);
  pass_->set_label_font(font_);
  depth_mode_ = depth;
  size_ = size;
  color_ = gl::make_texture(GL_TEXTURE_2D);
  depth_ = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(color_.name(), 1, GL_RGBA8, size.width_px, size.height_px);
  glTextureStorage2D(depth_.name(), 1, GL_DEPTH_COMPONENT32F, size.width_px, size.height_px);
  framebuffer_ = gl::make_framebuffer();
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
  glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
}

FrameBlock ObjectCanvas::upload_frame(const View& view) const {
  const double height = std::abs(ellipsoid_.to_geodetic(view.eye).height_m);
  const double near_m = std::max(0.1 * height, 0.05);
  const double far_m = glm::length(view.eye.xyz_m) + 1.5 * ellipsoid_.a_m();
  FrameBlock block = frame_of_camera(view, near_m, far_m);
  block.sun_ecef = glm::vec4(glm::vec3(glm::normalize(view.eye.xyz_m)), lit_ ? 1.0F : 0.0F);
  glNamedBufferSubData(frame_block_.name(), 0, sizeof(block), &block);
  return block;
}

ObjectPicture ObjectCanvas::draw(const ObjectScene& scene, const View& view) {
  const FrameBlock frame = upload_frame(view);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, size_.width_px, size_.height_px);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  const bool reversed = depth_mode_ == DepthMode::reversed;
  const DrawState state{.depth = DepthState{.test = static_cast<GLenum>(reversed ? GL_GREATER : GL_LESS)}};
  apply(state);
  glClearDepth(reversed ? 0.0 : 1.0);
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
  LayerObjects objects(scene, ellipsoid_, 1.0, kSelectedColor);
  objects.place(cut_objects(objects.take_job(), false));
  LayerBuffers buffers;
  pass_->set_layers({{&objects, &buffers}});
  EXPECT_TRUE(pass_->prepare());
  pass_->upload();
  pass_->place_labels(view, label_sight_, shown_labels_);
  draw_calls_ = 0;
  for (const ObjectPart part : {ObjectPart::underground, ObjectPart::above_ground}) {
    draw_calls_ += pass_->draw(part, frame, size_, state, ObjectChoice::all, hiding_radius_m_);
  }
  const auto row = static_cast<std::size_t>(size_.width_px) * 4;
  std::vector<std::uint8_t> bottom_up(row * static_cast<std::size_t>(size_.height_px));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(color_.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(bottom_up.size()),
                    bottom_up.data());
  ObjectPicture picture{size_, std::vector<std::uint8_t>(bottom_up.size())};
  for (int y = 0; y < size_.height_px; ++y) {
    std::copy_n(bottom_up.data() + row * static_cast<std::size_t>(size_.height_px - 1 - y), row,
                picture.rgba.data() + row * static_cast<std::size_t>(y));
  }
  pass_->set_layers({});
  return picture;
}

}  // namespace terrella::test
