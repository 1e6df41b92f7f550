#include "render/gl/context_mark.h"

#include <atomic>

namespace terrella {
namespace {
constexpr GLuint kPlace = 15;  // a vertex array has at least 16 attributes and bindings
}

ContextMark::ContextMark() : array_(gl::make_vertex_array()) {
  static std::atomic<GLint> marks = 1;
  mark_ = ++marks;
  glVertexArrayBindingDivisor(array_.name(), kPlace, static_cast<GLuint>(mark_));
}

bool ContextMark::is_current() const {
  if (glIsVertexArray(array_.name()) != GL_TRUE) return false;
  GLint mark = 0;
  glGetVertexArrayIndexediv(array_.name(), kPlace, GL_VERTEX_ATTRIB_ARRAY_DIVISOR, &mark);
  return mark == mark_;
}

}  // namespace terrella
