#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "render/gl/offscreen.h"

namespace terrella::test {

/// A headless GL for each test. What GL calls an error, by its callback or by glGetError, fails the test at its end.
class GlContextTest : public testing::Test {
 protected:
  void SetUp() override;
  /// Destroys the context; GL objects of the test must be gone before.
  void TearDown() override;

 private:
  std::unique_ptr<HeadlessContext> context_;
  std::vector<std::string> gl_errors_;
};

}  // namespace terrella::test
