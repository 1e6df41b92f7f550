#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>

#include "base/result.h"
#include "render/gl/gl_handle.h"
#include "text/text_shaper.h"

namespace terrella {

/// Place of a glyph's picture, including its halo, in the atlas and relative to the glyph's origin, pixels.
struct Glyph {
  short x = 0, y = 0, width = 0, height = 0;
  short left = 0, top = 0;  ///< upper left corner, right of and above the origin
};

/// The glyphs of fonts at one size. FreeType draws each into a texture when it is first requested: red is the covered
/// fraction of the pixel, green the halo. thread: main
class GlyphAtlas {
 public:
  static constexpr int kSide_px = 1024;

  [[nodiscard]] static Result<std::unique_ptr<GlyphAtlas>> create();

  /// Returns the picture of a glyph: an empty one if the atlas is full, or if the glyph has no ink.
  [[nodiscard]] Glyph glyph(const TextShaper& shaper, const ShapedGlyph& shaped);
  /// True once a glyph had no room. The atlas then keeps what it has until clear().
  [[nodiscard]] bool is_full() const { return full_; }
  void clear();
  [[nodiscard]] GLuint texture() const { return texture_.name(); }

 private:
  GlyphAtlas() = default;
  [[nodiscard]] Glyph draw(const FT_FaceRec_& face);
  bool find_room(Glyph& glyph);

  gl::Texture texture_;
  std::unordered_map<std::uint64_t, Glyph> glyphs_;  ///< by font and index
  int row_x_ = 0, row_y_ = 0, row_height_ = 0;
  bool full_ = false;
};

}  // namespace terrella
