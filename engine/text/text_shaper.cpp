#include "text/text_shaper.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <hb-ft.h>

#include <algorithm>
#include <array>
#include <string>

#include "text/text_runs.h"

namespace terrella {
namespace {

constexpr float kFixed = 64.0F;  // unit of FreeType and HarfBuzz here: 1/64 pixel
constexpr unsigned kToTheEnd = ~0U;
constexpr std::array<hb_feature_t, 2> kNoLigatures{
    {{HB_TAG('l', 'i', 'g', 'a'), 0, 0, kToTheEnd}, {HB_TAG('c', 'l', 'i', 'g'), 0, 0, kToTheEnd}}};

hb_unicode_general_category_t category_of(char32_t character) {
  return hb_unicode_general_category(hb_unicode_funcs_get_default(), character);
}

/// True for marks and spaces, for which the font of the letter before them comes first.
bool follows_letter(char32_t character) {
  switch (category_of(character)) {
    case HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_ENCLOSING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_SPACE_SEPARATOR:
      return true;
    default:
      return false;
  }
}

/// True for characters without a picture: joiners, signs of direction, and selectors of a variant of the letter before.
bool is_invisible(char32_t c) {
  return category_of(c) == HB_UNICODE_GENERAL_CATEGORY_FORMAT || (c >= 0xFE00 && c <= 0xFE0F) ||
         (c >= 0xE0100 && c <= 0xE01EF);
}

/// Returns a text with spaces in place of control characters. Letters are joined with their marks where there is one
/// character for both, because fonts may have that alone: syllables of Korean, for one.
std::u32string composed(std::u32string_view text) {
  std::u32string result;
  for (const char32_t c : text) {
    hb_codepoint_t both = 0;
    if (category_of(c) == HB_UNICODE_GENERAL_CATEGORY_CONTROL) {
      result.push_back(U' ');
    } else if (!result.empty() && hb_unicode_compose(hb_unicode_funcs_get_default(), result.back(), c, &both) != 0) {
      result.back() = both;
    } else {
      result.push_back(c);
    }
  }
  return result;
}

/// True for scripts that join letters, or hang them on one line, so that room between two letters would break words.
bool joins_letters(std::uint32_t script) {
  constexpr std::array kJoining = {HB_SCRIPT_ADLAM,     HB_SCRIPT_ARABIC,  HB_SCRIPT_BENGALI,    HB_SCRIPT_DEVANAGARI,
                                   HB_SCRIPT_GURMUKHI,  HB_SCRIPT_MANDAIC, HB_SCRIPT_MANICHAEAN, HB_SCRIPT_MODI,
                                   HB_SCRIPT_MONGOLIAN, HB_SCRIPT_NKO,     HB_SCRIPT_PHAGS_PA,   HB_SCRIPT_SYRIAC,
                                   HB_SCRIPT_TIBETAN,   HB_SCRIPT_TIRHUTA};
  return std::ranges::find(kJoining, static_cast<hb_script_t>(script)) != kJoining.end();
}

}  // namespace

Result<std::unique_ptr<TextShaper>> TextShaper::create(std::vector<std::byte> font, int size_px) {
  std::unique_ptr<TextShaper> shaper(new TextShaper);
  shaper->bytes_ = std::move(font);
  shaper->size_px_ = size_px;
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) return Error{"FreeType cannot be started"};
  shaper->library_ = {library, &FT_Done_FreeType};
  FT_Face face = nullptr;
  if (FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(shaper->bytes_.data()),
                         static_cast<FT_Long>(shaper->bytes_.size()), 0, &face) != 0) {
    return Error{"the labels' font is not a font that FreeType reads"};
  }
  if (!shaper->add_font(face)) return Error{"the labels' font has no such size"};
  shaper->buffer_ = {hb_buffer_create(), &hb_buffer_destroy};
  return shaper;
}

bool TextShaper::add_font(FT_Face face) {
  Font font{{face, &FT_Done_Face}, {}};
  if (FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size_px_)) != 0) return false;
  font.shaped = {hb_ft_font_create_referenced(face), &hb_font_destroy};
  hb_ft_font_set_load_flags(font.shaped.get(), FT_LOAD_DEFAULT);
  fonts_.push_back(std::move(font));
  return true;
}

void TextShaper::set_size(int size_px) {
  if (size_px == size_px_) return;
  size_px_ = size_px;
  for (const Font& font : fonts_) {
    const bool has_size = FT_Set_Pixel_Sizes(font.face.get(), 0, static_cast<FT_UInt>(size_px)) == 0;
    if (has_size) hb_ft_font_changed(font.shaped.get());
  }
}

std::optional<std::uint32_t> TextShaper::search_font(char32_t character) {
  if (!search_) search_.emplace();
  const std::optional<FontFace> file = search_->find(character);
  if (!file) return std::nullopt;
  const auto known = std::ranges::find(on_disk_, *file);
  if (known != on_disk_.end()) return static_cast<std::uint32_t>(known - on_disk_.begin() + 1);
  FT_Face face = nullptr;
  if (FT_New_Face(library_.get(), file->path.c_str(), file->index, &face) != 0 || !add_font(face)) return std::nullopt;
  on_disk_.push_back(*file);
  return static_cast<std::uint32_t>(fonts_.size() - 1);
}

std::uint32_t TextShaper::font_of(char32_t character) {
  if (FT_Get_Char_Index(fonts_.front().face.get(), character) != 0) return 0;
  const auto [entry, is_new] = found_.try_emplace(character, 0U);
  if (is_new) {
    const std::optional<std::uint32_t> font = search_font(character);
    if (font) {
      entry->second = *font;
    } else {
      without_font_.insert(character);
    }
  }
  return entry->second;
}

// Marks and spaces are taken from the font of the letter before them if that has them, so that they are shaped
// together.
std::vector<std::uint32_t> TextShaper::fonts_of(std::u32string_view text) {
  std::vector<std::uint32_t> fonts;
  for (const char32_t character : text) {
    const std::uint32_t before = fonts.empty() ? 0 : fonts.back();
    const bool with_letter =
        is_invisible(character) || (follows_letter(character) && FT_Get_Char_Index(face(before), character) != 0);
    fonts.push_back(with_letter ? before : font_of(character));
  }
  return fonts;
}

ShapedText TextShaper::shape(std::u32string_view given, float spacing_px) {
  const std::u32string text = composed(given);
  const std::vector<std::uint32_t> fonts = fonts_of(text);
  ShapedText line;
  hb_buffer_t* const buffer = buffer_.get();
  for (const TextRun& run : text_runs(text, fonts)) {
    hb_buffer_clear_contents(buffer);
    // With the text around, because letters join across fonts.
    hb_buffer_add_utf32(buffer, reinterpret_cast<const std::uint32_t*>(text.data()), static_cast<int>(text.size()),
                        static_cast<unsigned>(run.first), static_cast<int>(run.count));
    hb_buffer_set_direction(buffer, run.right_to_left ? HB_DIRECTION_RTL : HB_DIRECTION_LTR);
    hb_buffer_set_script(buffer, static_cast<hb_script_t>(run.script));
    hb_buffer_set_language(buffer, hb_language_get_default());
    const float room_px = joins_letters(run.script) ? 0.0F : spacing_px;
    // A ligature such as "fi" would be two letters without room between them.
    hb_shape(fonts_[run.font].shaped.get(), buffer, kNoLigatures.data(), room_px > 0.0F ? kNoLigatures.size() : 0);
    unsigned count = 0;
    const hb_glyph_info_t* const glyphs = hb_buffer_get_glyph_infos(buffer, &count);
    const hb_glyph_position_t* const places = hb_buffer_get_glyph_positions(buffer, &count);
    for (unsigned k = 0; k < count; ++k) {
      const bool is_letter = k == 0 || glyphs[k].cluster != glyphs[k - 1].cluster;
      if (is_letter && !line.glyphs.empty()) line.width_px += room_px;
      line.glyphs.push_back({run.font, glyphs[k].codepoint, line.width_px + float(places[k].x_offset) / kFixed,
                             float(places[k].y_offset) / kFixed});
      line.width_px += float(places[k].x_advance) / kFixed;
    }
  }
  return line;
}

int TextShaper::ascent_px() const { return static_cast<int>(face(0)->size->metrics.ascender / 64); }
int TextShaper::descent_px() const { return static_cast<int>(-face(0)->size->metrics.descender / 64); }

}  // namespace terrella
