#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace terrella::gl {

/// Owns one GL object. Movable, not copyable. `Traits::destroy` deletes the object. thread: main
template <class Traits>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint name) : name_(name) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  [[nodiscard]] GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  void reset() {
    if (name_ != 0) Traits::destroy(name_);
    name_ = 0;
  }
  GLuint name_ = 0;
};

struct BufferTraits {
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct TextureTraits {
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct SamplerTraits {
  static void destroy(GLuint name) { glDeleteSamplers(1, &name); }
};
struct VertexArrayTraits {
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct FramebufferTraits {
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct ProgramTraits {
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

using Buffer = Handle<BufferTraits>;
using Texture = Handle<TextureTraits>;
using Sampler = Handle<SamplerTraits>;
using VertexArray = Handle<VertexArrayTraits>;
using Framebuffer = Handle<FramebufferTraits>;
using Program = Handle<ProgramTraits>;

/// Loads the delete functions while a context is current. Without a context they could not be loaded any more.
inline void find_deletes() {
  glDeleteBuffers(0, nullptr);
  glDeleteTextures(0, nullptr);
  glDeleteSamplers(0, nullptr);
  glDeleteVertexArrays(0, nullptr);
  glDeleteFramebuffers(0, nullptr);
  glDeleteProgram(0);
}

[[nodiscard]] inline Buffer make_buffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return Buffer(name);
}
[[nodiscard]] inline Texture make_texture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return Texture(name);
}
[[nodiscard]] inline Sampler make_sampler() {
  GLuint name = 0;
  glCreateSamplers(1, &name);
  return Sampler(name);
}
[[nodiscard]] inline VertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}
[[nodiscard]] inline Framebuffer make_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return Framebuffer(name);
}

}  // namespace terrella::gl
