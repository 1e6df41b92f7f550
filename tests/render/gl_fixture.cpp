#include "gl_fixture.h"

#include <epoxy/gl.h>

namespace terrella::test {
namespace {

void APIENTRY note_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                           const void* list) {
  if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
  static_cast<std::vector<std::string>*>(const_cast<void*>(list))->emplace_back(text, static_cast<std::size_t>(length));
}

}  // namespace

void GlTest::SetUp() {
  Result<std::unique_ptr<HeadlessContext>> context = HeadlessContext::create();
  ASSERT_TRUE(context) << context.error().message;
  context_ = std::move(*context);
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(note_message, &gl_errors_);
}

void GlTest::TearDown() {
  if (!context_) return;
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  for (const std::string& error : gl_errors_) ADD_FAILURE() << "OpenGL says: " << error;
  target_.reset();
  glDebugMessageCallback(nullptr, nullptr);
  context_.reset();
}

std::unique_ptr<Globe> GlTest::make_globe(const GlobeOptions& options, std::shared_ptr<TileSource> source) {
  Result<std::unique_ptr<Globe>> globe = Globe::create(options, std::move(source));
  if (!globe) {
    ADD_FAILURE() << globe.error().message;
    return nullptr;
  }
  return std::move(*globe);
}

void GlTest::resize(Viewport size) {
  if (target_ && size.width_px == size_.width_px && size.height_px == size_.height_px) return;
  target_ = std::make_unique<OffscreenTarget>(size);
  size_ = size;
}

FrameStats GlTest::draw(Globe& globe, Viewport size) {
  resize(size);
  return globe.render(target_->framebuffer(), size);
}

FrameStats GlTest::settle(Globe& globe, Viewport size) {
  resize(size);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  EXPECT_TRUE(globe.render_until_settled(target_->framebuffer(), size, deadline)) << "not settled after a minute";
  return globe.render(target_->framebuffer(), size);
}

Picture GlTest::picture() const { return {size_, target_->read()}; }

}  // namespace terrella::test
