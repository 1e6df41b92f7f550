#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"
#include "render/objects/glyph_atlas.h"
#include "text/text_shaper.h"

namespace terrella {

/// The look of a line, which decides its glyphs and their places.
struct LineLook {
  GlyphLook glyphs;
  int spacing_64ths = 0;  ///< room between two letters, 1/64 px
  auto operator<=>(const LineLook&) const = default;
};
/// `scale`: pixels of a unit of the look, more than 0, to kMostLineScale.
[[nodiscard]] LineLook line_look(const LabelLook& look, float scale = 1.0F);
inline constexpr float kMostLineScale = 8.0F;
/// Returns the pixels from the middle of a line down to its baseline, which centre small letters on the middle.
[[nodiscard]] float drop_px(const LineLook& look);

struct GlyphLine {
  std::vector<std::pair<Glyph, glm::vec2>> glyphs;  ///< glyphs, each with its origin, right of and above the pen
  float width_px = 0.0F;
  bool is_whole = true;  ///< the atlas had room for all glyphs
};

/// Lines of text in any script: shaped (TextShaper) and drawn into an atlas once, and kept. thread: main
class GlyphLines {
 public:
  /// `font` contains the bytes of a font file, which is asked first for each letter.
  [[nodiscard]] static Result<std::unique_ptr<GlyphLines>> create(std::vector<std::byte> font);

  /// Returns a line, which is valid until the end of with_room().
  [[nodiscard]] const GlyphLine& line(const std::u32string& text, const LineLook& look);
  [[nodiscard]] float half_height_px(const LineLook& look) {
    const float known_px = half_heights_px_[static_cast<std::size_t>(look.glyphs.text_px)];
    return known_px > 0.0F ? known_px : measure_half_height_px(look.glyphs.text_px);
  }
  /// Calls a function that makes all lines of a frame. If the atlas is full of the letters of earlier frames, those of
  /// this frame get all of it in a further call, then a larger one.
  template <class MakeLines>
  void with_room(const MakeLines& make_lines) {
    if (line_count_ > kMostLines) forget();
    make_lines();
    for (bool is_fresh = false; atlas_->is_full() && (!is_fresh || atlas_->grow()); is_fresh = true) {
      forget();
      make_lines();
    }
  }
  [[nodiscard]] GLuint texture() const { return atlas_->texture(); }
  [[nodiscard]] int side_px() const { return atlas_->side_px(); }
  /// Letters that no font has, so far.
  [[nodiscard]] const std::set<char32_t>& without_font() const { return shaper_->without_font(); }

 private:
  static constexpr std::size_t kMostLines = 10'000;

  GlyphLines() = default;
  [[nodiscard]] float measure_half_height_px(int text_px);
  void forget();

  std::unique_ptr<TextShaper> shaper_;
  std::unique_ptr<GlyphAtlas> atlas_;
  std::map<LineLook, std::unordered_map<std::u32string, GlyphLine>> lines_;
  std::size_t line_count_ = 0;  ///< lines in lines_
  /// Half the height of a line by the size of the text; 0: not measured yet.
  std::array<float, std::size_t(kMostText_px* kMostLineScale) + 1> half_heights_px_{};
};

}  // namespace terrella
