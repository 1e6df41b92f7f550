#pragma once

#include "render/gl/gl_handle.h"

namespace terrella {

/// Recognises the context in which it was made. It marks a vertex array, because contexts share no vertex arrays, not
/// even contexts that share textures. thread: main (of the context)
class ContextMark {
 public:
  ContextMark();
  [[nodiscard]] bool is_current() const;

 private:
  gl::VertexArray array_;
  GLint mark_;  ///< another context may have a vertex array of the same name, without this mark
};

}  // namespace terrella
