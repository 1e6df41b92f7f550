#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace terrella::gl {

/// Owns one GL object. Movable, not copyable. `Delete` deletes the object. thread: main
template <void (*Delete)(GLuint)>
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
    if (name_ != 0) Delete(name_);
    name_ = 0;
  }
  GLuint name_ = 0;
};

inline void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
inline void delete_sampler(GLuint name) { glDeleteSamplers(1, &name); }
inline void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void delete_program(GLuint name) { glDeleteProgram(name); }

using Buffer = Handle<delete_buffer>;
using Texture = Handle<delete_texture>;
using Sampler = Handle<delete_sampler>;
using VertexArray = Handle<delete_vertex_array>;
using Framebuffer = Handle<delete_framebuffer>;
using Program = Handle<delete_program>;

/// Loads the delete functions while a context is current. Without a context they could not be loaded any more.
inline void find_deletes() {
  glDeleteBuffers(0, nullptr);
  glDeleteTextures(0, nullptr);
  glDeleteSamplers(0, nullptr);
  glDeleteVertexArrays(0, nullptr);
  glDeleteFramebuffers(0, nullptr);
  glDeleteProgram(0);
}

template <class Object>
[[nodiscard]] Object made(void (*create)(GLsizei, GLuint*)) {
  GLuint name = 0;
  create(1, &name);
  return Object(name);
}
[[nodiscard]] inline Buffer make_buffer() { return made<Buffer>(glCreateBuffers); }
[[nodiscard]] inline Sampler make_sampler() { return made<Sampler>(glCreateSamplers); }
[[nodiscard]] inline VertexArray make_vertex_array() { return made<VertexArray>(glCreateVertexArrays); }
[[nodiscard]] inline Framebuffer make_framebuffer() { return made<Framebuffer>(glCreateFramebuffers); }
[[nodiscard]] inline Texture make_texture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return Texture(name);
}

}  // namespace terrella::gl
