#pragma once

#include <cstddef>
#include <memory>
#include <unordered_map>
#include <vector>

#include "base/result.h"
#include "render/gl/gl_handle.h"

struct FT_FaceRec_;
struct FT_LibraryRec_;

namespace terrella {

/// Place of a character's picture, including its halo, in the atlas and relative to the pen, pixels.
struct Glyph {
  short x = 0, y = 0, width = 0, height = 0;
  short left = 0, top = 0;  ///< upper left corner, right of and above the pen
  float advance = 0.0F;     ///< advance of the pen
};

/// The characters of one font at one size. FreeType draws each into a texture when it is first requested: red is the
/// covered fraction of the pixel, green the halo. thread: main
class GlyphAtlas {
 public:
  static constexpr int kSide_px = 1024;

  /// `font` contains the bytes of a font file (TrueType, OpenType).
  [[nodiscard]] static Result<std::unique_ptr<GlyphAtlas>> create(std::vector<std::byte> font, int size_px);

  /// Returns the picture of a character: the font's replacement mark if the font does not have the character, an empty
  /// picture if the atlas is full.
  [[nodiscard]] const Glyph& glyph(char32_t character);
  /// Change of the distance between two characters, pixels; negative brings them closer.
  [[nodiscard]] float kerning(char32_t left, char32_t right) const;
  [[nodiscard]] int ascent_px() const;
  [[nodiscard]] int descent_px() const;  ///< depth below the pen, positive
  [[nodiscard]] GLuint texture() const { return texture_.name(); }

 private:
  GlyphAtlas() = default;
  void draw(Glyph& glyph);
  bool find_room(Glyph& glyph);

  std::vector<std::byte> font_;
  std::shared_ptr<FT_LibraryRec_> library_;
  std::shared_ptr<FT_FaceRec_> face_;
  gl::Texture texture_;
  std::unordered_map<char32_t, Glyph> glyphs_;
  int row_x_ = 0, row_y_ = 0, row_height_ = 0;
};

}  // namespace terrella
