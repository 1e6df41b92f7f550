#pragma once

#include <memory>
#include <vector>

#include "globe/globe.h"
#include "tests/gl/gl_context_test.h"
#include "tests/gl/painted_source.h"

namespace terrella::test {

/// RGBA8, rows from the top.
struct Picture {
  Viewport size;
  std::vector<std::uint8_t> rgba;
  [[nodiscard]] Color at(int x, int y) const {
    const std::size_t k =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width_px) + static_cast<std::size_t>(x));
    return {rgba[k], rgba[k + 1], rgba[k + 2]};
  }
};

/// Draws globes.
class GlTest : public GlContextTest {
 protected:
  void TearDown() override;

  [[nodiscard]] static std::unique_ptr<Globe> make_globe(const GlobeOptions& options,
                                                         std::shared_ptr<TileSource> source);
  /// Draws one frame into an offscreen target of that size, which is kept.
  FrameStats draw(Globe& globe, Viewport size);
  /// Draws until settled; fails the test if that takes longer than a minute.
  FrameStats settle(Globe& globe, Viewport size);
  [[nodiscard]] Picture picture() const;

 private:
  void resize(Viewport size);

  std::unique_ptr<OffscreenTarget> target_;
  Viewport size_{0, 0};
};

/// Imagery alone on black, so that a pixel without imagery is black.
[[nodiscard]] inline GlobeOptions unlit_options() {
  GlobeOptions options;
  options.unlit = true;
  return options;
}

}  // namespace terrella::test
