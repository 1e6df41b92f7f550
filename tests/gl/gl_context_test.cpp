#include "tests/gl/gl_context_test.h"

#include <epoxy/gl.h>

namespace terrella::test {
namespace {

void APIENTRY note_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                           const void* list) {
  if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
  static_cast<std::vector<std::string>*>(const_cast<void*>(list))->emplace_back(text, static_cast<std::size_t>(length));
}

}  // namespace

void GlContextTest::SetUp() {
  Result<std::unique_ptr<HeadlessContext>> context = HeadlessContext::create();
  ASSERT_TRUE(context) << context.error().message;
  context_ = std::move(*context);
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(note_message, &gl_errors_);
}

void GlContextTest::TearDown() {
  if (!context_) return;
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  for (const std::string& error : gl_errors_) ADD_FAILURE() << "OpenGL says: " << error;
  glDebugMessageCallback(nullptr, nullptr);
  context_.reset();
}

}  // namespace terrella::test
