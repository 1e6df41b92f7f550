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

/// Where a character's picture lies in the atlas, and beside the pen: pixels, its halo with it.
struct Glyph {
  short x = 0, y = 0, width = 0, height = 0;
  short left = 0, top = 0;  ///< of its upper left corner, right of and over the pen
  float advance = 0.0F;     ///< of the pen
};

/// The characters of one font at one size, drawn by FreeType into a texture when they are first asked for: how much of
/// a pixel the character covers in red, its halo in green. thread: main (of the context)
class GlyphAtlas {
 public:
  static constexpr int kSide_px = 1024;

  /// `font` is a font file's bytes (TrueType, OpenType).
  [[nodiscard]] static Result<std::unique_ptr<GlyphAtlas>> create(std::vector<std::byte> font, int size_px);

  /// The font's mark for what it lacks, where it lacks the character; one without a picture once the atlas is full.
  [[nodiscard]] const Glyph& glyph(char32_t character);
  /// How much nearer to each other two characters stand, pixels, negative.
  [[nodiscard]] float kerning(char32_t left, char32_t right) const;
  [[nodiscard]] int ascent_px() const;
  [[nodiscard]] int descent_px() const;  ///< under the pen, positive
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
