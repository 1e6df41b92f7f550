#include "render/gl/framebuffer_check.h"

#include <fmt/format.h>

#include <string>

namespace terrella {
namespace {

std::string name_of(GLuint framebuffer) {
  return framebuffer == 0 ? std::string("the window's framebuffer") : fmt::format("framebuffer {}", framebuffer);
}

const char* reason_of(GLenum status) {
  switch (status) {
    case GL_FRAMEBUFFER_UNDEFINED:
      return "the context has no window; give a framebuffer of your own";
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
      return "an attachment cannot be drawn into; give it storage within the driver's limits";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
      return "it has no attachment; attach a colour texture";
    case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
      return "its attachments have different numbers of samples";
    case GL_FRAMEBUFFER_UNSUPPORTED:
      return "the driver does not support its formats together";
    default:
      return "its attachments do not fit together";
  }
}

GLint attachment(GLuint framebuffer, GLenum buffer, GLenum what) {
  GLint value = GL_NONE;
  glGetNamedFramebufferAttachmentParameteriv(framebuffer, buffer, what, &value);
  return value;
}

}  // namespace

Status check_framebuffer(GLuint framebuffer) {
  if (framebuffer != 0 && glIsFramebuffer(framebuffer) != GL_TRUE) {
    return Error{fmt::format("there is no framebuffer {} in this context; make it first", framebuffer)};
  }
  const GLenum status = glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return Done{};
  return Error{fmt::format("{} is not complete: {}", name_of(framebuffer), reason_of(status))};
}

Status check_colors(GLuint framebuffer) {
  GLint buffer = GL_NONE;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glGetIntegerv(GL_DRAW_BUFFER, &buffer);
  if (framebuffer == 0 && buffer != GL_NONE) return Done{};
  const bool has_colors = buffer != GL_NONE && attachment(framebuffer, static_cast<GLenum>(buffer),
                                                          GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) != GL_NONE;
  if (!has_colors)
    return Error{name_of(framebuffer) + " draws no colours; attach a colour texture, or set glDrawBuffer()"};
  const GLint type = attachment(framebuffer, static_cast<GLenum>(buffer), GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE);
  if (type != GL_INT && type != GL_UNSIGNED_INT) return Done{};
  return Error{name_of(framebuffer) + " has whole numbers in place of colours; attach a texture such as GL_RGBA8"};
}

Status check_depth(GLuint framebuffer) {
  const GLenum buffer = framebuffer == 0 ? GL_DEPTH : GL_DEPTH_ATTACHMENT;
  if (attachment(framebuffer, buffer, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) != GL_NONE) return Done{};
  return Error{name_of(framebuffer) + " has no depth; attach a depth texture"};
}

}  // namespace terrella
