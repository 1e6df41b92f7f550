#include "render/gl/frame_targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "render/gl/storage.h"

namespace terrella {
namespace {

gl::Texture make_picture(GLenum format, Viewport size) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, size.width_px, size.height_px);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  return texture;
}

gl::Texture make_samples(GLenum format, const FrameTargets::Form& form) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D_MULTISAMPLE);
  glTextureStorage2DMultisample(texture.name(), form.samples, format, form.size.width_px, form.size.height_px, GL_TRUE);
  return texture;
}

gl::Framebuffer make_target(const gl::Texture& color, const gl::Texture& depth, bool has_stencil) {
  gl::Framebuffer target = gl::make_framebuffer();
  glNamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
  glNamedFramebufferTexture(target.name(), has_stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
                            depth.name(), 0);
  return target;
}

}  // namespace

int FrameTargets::longest_side_px() {
  GLint texture = 0;
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  return std::min({texture, viewport[0], viewport[1]});
}

Status FrameTargets::fit(const Form& form) {
  if (form_ == form) return Done{};
  form_ = form;
  frame_ = 0;
  const GLenum depth_format = form.has_stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F;
  color_ = make_picture(GL_RGBA8, form.size);
  depth_ = make_picture(depth_format, form.size);
  beside_ = {};
  framebuffer_ = make_target(color_, depth_, form.has_stencil);
  color_samples_ = {};
  depth_samples_ = {};
  resolved_ = {};
  if (form.samples > 0) {
    color_samples_ = make_samples(GL_RGBA8, form);
    depth_samples_ = make_samples(depth_format, form);
    resolved_ = std::exchange(framebuffer_, make_target(color_samples_, depth_samples_, form.has_stencil));
  }
  if (has_memory()) return Done{};
  *this = FrameTargets();
  return Error{fmt::format("the driver has no memory for a picture of {}x{} pixels; draw a smaller one",
                           form.size.width_px, form.size.height_px)};
}

bool FrameTargets::has_memory() const {
  if (!gl::has_storage(color_) || !gl::has_storage(depth_)) return false;
  return form_.samples == 0 || (gl::has_storage(color_samples_) && gl::has_storage(depth_samples_));
}

FrameTargets::Beside FrameTargets::beside(std::size_t which) {
  gl::Texture& texture = beside_[which];
  gl::Framebuffer& framebuffer = beside_framebuffer_[which];
  if (!texture) {
    texture = make_picture(GL_RGBA8, form_.size);
    if (!gl::has_storage(texture)) texture = {};
    if (!texture) return {};
    framebuffer = gl::make_framebuffer();
    glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
  }
  return {framebuffer.name(), texture.name()};
}

void FrameTargets::resolve_color(const Beside& beside) const {
  if (form_.samples == 0) return;
  resolve(GL_COLOR_BUFFER_BIT, resolved_.name());
  resolve(GL_COLOR_BUFFER_BIT, beside.framebuffer);
}

void FrameTargets::resolve_depth() const {
  if (form_.samples > 0) resolve(GL_DEPTH_BUFFER_BIT, resolved_.name());
}

void FrameTargets::resolve(GLbitfield what, GLuint into) const {
  const auto [width, height] = form_.size;
  glBlitNamedFramebuffer(framebuffer_.name(), into, 0, 0, width, height, 0, 0, width, height, what, GL_NEAREST);
}

void FrameTargets::copy_to(GLuint framebuffer, glm::ivec2 corner_px) const {
  const auto [width, height] = form_.size;
  glBlitNamedFramebuffer(framebuffer_.name(), framebuffer, 0, 0, width, height, corner_px.x, corner_px.y,
                         corner_px.x + width, corner_px.y + height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace terrella
