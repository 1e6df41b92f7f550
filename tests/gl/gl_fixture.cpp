#include "tests/gl/gl_fixture.h"

namespace terrella::test {

void GlTest::TearDown() {
  target_.reset();
  GlContextTest::TearDown();
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
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(3);
  EXPECT_TRUE(globe.render_until_settled(target_->framebuffer(), size, deadline)) << "not settled after three minutes";
  return globe.render(target_->framebuffer(), size);
}

Picture GlTest::picture() const { return {size_, target_->read()}; }

}  // namespace terrella::test
