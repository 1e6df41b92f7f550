#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "text/font_search.h"

struct FT_FaceRec_;
struct FT_LibraryRec_;
struct hb_buffer_t;
struct hb_font_t;

namespace terrella {

/// A picture of a font, and where it stands in a line.
struct ShapedGlyph {
  std::uint32_t font = 0;   ///< for TextShaper::face()
  std::uint32_t index = 0;  ///< number of the glyph in the font
  float x_px = 0.0F;        ///< its origin, right of the line's beginning
  float y_px = 0.0F;        ///< its origin, above the baseline
};

/// The glyphs of a line from left to right.
struct ShapedText {
  std::vector<ShapedGlyph> glyphs = {};
  float width_px = 0.0F;
};

/// Shapes lines of text in any script: HarfBuzz chooses and places the glyphs, FriBidi orders them, and
/// Fontconfig finds a font of the system for letters that the given font does not have. Fonts of the system are looked
/// up when the first such letter comes. thread: any, but one call at a time
class TextShaper {
 public:
  /// `font` contains the bytes of a font file (TrueType, OpenType). It is asked first for each letter. `size_px` is the
  /// size until set_size().
  [[nodiscard]] static Result<std::unique_ptr<TextShaper>> create(std::vector<std::byte> font, int size_px);

  /// Sets the size of the next lines and faces. Pictures of letters that have no other size keep theirs.
  void set_size(int size_px);
  /// Returns the line of a text. A letter that no font has is the replacement mark of the given font. Control
  /// characters are spaces. `spacing_px` of room comes between two letters, but not between letters that their script
  /// joins, nor between a letter and its marks.
  [[nodiscard]] ShapedText shape(std::u32string_view text, float spacing_px = 0.0F);
  /// Returns the face of a font, at the present size, to draw its glyphs. It lives as long as the shaper.
  [[nodiscard]] FT_FaceRec_* face(std::uint32_t font) const { return fonts_[font].face.get(); }
  /// Letters that no font has, so far.
  [[nodiscard]] const std::set<char32_t>& without_font() const { return without_font_; }
  [[nodiscard]] int ascent_px() const;   ///< rise of the given font above the baseline
  [[nodiscard]] int descent_px() const;  ///< depth below the baseline, positive

 private:
  struct Font {
    std::shared_ptr<FT_FaceRec_> face;
    std::shared_ptr<hb_font_t> shaped;
  };

  TextShaper() = default;
  [[nodiscard]] bool add_font(FT_FaceRec_* face);
  [[nodiscard]] std::uint32_t font_of(char32_t character);
  [[nodiscard]] std::optional<std::uint32_t> search_font(char32_t character);
  [[nodiscard]] std::vector<std::uint32_t> fonts_of(std::u32string_view text);

  std::vector<std::byte> bytes_;
  int size_px_ = 0;
  std::shared_ptr<FT_LibraryRec_> library_;
  std::vector<Font> fonts_;        ///< the given font, and those of the system that were needed
  std::vector<FontFace> on_disk_;  ///< files of the fonts after the first
  std::optional<FontSearch> search_;
  std::map<char32_t, std::uint32_t> found_;  ///< fonts of letters that the given font does not have
  std::set<char32_t> without_font_;
  std::shared_ptr<hb_buffer_t> buffer_;
};

}  // namespace terrella
