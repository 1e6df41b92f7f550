#include "render/gl/frame_targets.h"

namespace terrella {
namespace {

gl::Texture make_picture(GLenum format, Viewport size) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, size.width_px, size.height_px);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  return texture;
}

}  // namespace

void FrameTargets::fit(Viewport size, bool with_stencil) {
  if (size_ == size && has_stencil_ == with_stencil) return;
  size_ = size;
  has_stencil_ = with_stencil;
  color_ = make_picture(GL_RGBA8, size);
  depth_ = make_picture(with_stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F, size);
  beside_ = {};
  framebuffer_ = gl::make_framebuffer();
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
  glNamedFramebufferTexture(framebuffer_.name(), with_stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
                            depth_.name(), 0);
}

FrameTargets::Beside FrameTargets::beside() {
  if (!beside_) {
    beside_ = make_picture(GL_RGBA8, size_);
    beside_framebuffer_ = gl::make_framebuffer();
    glNamedFramebufferTexture(beside_framebuffer_.name(), GL_COLOR_ATTACHMENT0, beside_.name(), 0);
  }
  return {beside_framebuffer_.name(), beside_.name()};
}

void FrameTargets::copy_to(GLuint framebuffer, glm::ivec2 corner_px) const {
  glBlitNamedFramebuffer(framebuffer_.name(), framebuffer, 0, 0, size_.width_px, size_.height_px, corner_px.x,
                         corner_px.y, corner_px.x + size_.width_px, corner_px.y + size_.height_px, GL_COLOR_BUFFER_BIT,
                         GL_NEAREST);
}

}  // namespace terrella
