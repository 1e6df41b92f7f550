#pragma once

#include <memory>
#include <vector>

#include "geo/objects.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// The icons of one layer in one texture with mipmaps: premultiplied alpha. The pixels of an icon's rim go on around
/// the icon, so that no mipmap mixes neighbours. thread: main
class IconAtlas {
 public:
  /// The longest icon may be drawn as small as this without aliasing, pixels.
  static constexpr int kLeastSide_px = 8;

  /// Packs the icons anew if they are others than before. False if the driver has no memory for them; the next call
  /// tries again.
  [[nodiscard]] bool follow(const std::vector<std::shared_ptr<const IconImage>>& icons);
  [[nodiscard]] GLuint texture() const { return texture_.name(); }
  /// One texel for each icon: left, top, width and height in the texture.
  [[nodiscard]] GLuint places() const { return places_.name(); }

 private:
  std::vector<std::shared_ptr<const IconImage>> icons_;
  gl::Texture texture_, places_;
};

}  // namespace terrella
