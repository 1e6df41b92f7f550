#include "apps/viewer/panels/panel_fonts.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "apps/process/data_dir.h"
#include "base/code_points.h"
#include "streaming/file_bytes.h"
#include "text/font_search.h"
#include "text/visual_text.h"

namespace terrella {
namespace {

constexpr float kText_px = 15.0F;
constexpr float kEm = 1.0F / 1.164F;      // em of DejaVu Sans, in text heights
constexpr float kDefaultText_px = 13.0F;  // size of ImGui's own small font
constexpr std::size_t kMostFontBytes = 128UL << 20;
constexpr std::size_t kMostLetters = 4096;  // keeps the texture of large letters within OpenGL's limits
constexpr char32_t kLastLetter = 0xFFFC;    // ImGui's letters have 16 bits; U+FFFD stands for broken text
// Latin, general punctuation, arrows, the minus sign, which are always loaded: pairs of first and last.
constexpr std::array<ImWchar, 9> kAlways = {0x20, 0x17F, 0x2010, 0x2027, 0x2190, 0x2193, 0x2212, 0x2212, 0};

struct PanelFont {
  FontFace face;
  std::vector<std::byte> bytes = {};  ///< empty if ImGui cannot read the font
  std::vector<ImWchar> letters = {};  ///< wanted letters that the font has
};

/// All letters that panels wanted, and their fonts.
struct PanelLetters {
  std::set<char32_t> known = {};          ///< wanted at any time
  std::vector<ImWchar> waiting = {};      ///< their fonts are not searched yet
  std::vector<PanelFont> fonts = {};      ///< DejaVu Sans first
  std::optional<ImWchar> newest = {};     ///< letter that was last found in a font
  std::optional<FontSearch> search = {};  ///< made when a letter is first missing in DejaVu Sans
};

PanelLetters& all() {
  static PanelLetters letters;
  return letters;
}

bool is_always_there(char32_t letter) {
  for (std::size_t k = 0; kAlways[k] != 0; k += 2) {
    if (letter >= kAlways[k] && letter <= kAlways[k + 1]) return true;
  }
  return false;
}

/// True for a file that ImGui can begin to read; it aborts on others, for example Type 1 fonts.
bool is_true_type(std::span<const std::byte> bytes) {
  constexpr std::array<std::string_view, 4> kBeginnings = {{{"\0\1\0\0", 4}, "true", "OTTO", "ttcf"}};
  return std::ranges::any_of(kBeginnings, [&](std::string_view one) { return as_text(bytes).starts_with(one); });
}

PanelFont read_font(const FontFace& face) {
  PanelFont font{face};
  auto bytes = read_file(face.path, kMostFontBytes);
  if (bytes && is_true_type(*bytes)) font.bytes = *std::move(bytes);
  return font;
}

/// Adds a font to an atlas, which reads bytes and ranges once it is built. A further font fills in for the first one,
/// with letters of the same em: line heights differ.
void add_font(ImFontAtlas& atlas, PanelFont& font, float size_px, const ImVector<ImWchar>& ranges) {
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  config.FontNo = font.face.index & 0xFFFF;  // the upper bits choose an instance of a variable font
  const bool further = !atlas.Fonts.empty();
  if (further) {
    config.MergeMode = true;
    config.OversampleH = 1;  // a third of the texture
    config.PixelSnapH = true;
  }
  atlas.AddFontFromMemoryTTF(font.bytes.data(), static_cast<int>(font.bytes.size()), size_px, &config, ranges.Data);
  if (further) atlas.ConfigData.back().SizePixels = -kEm * size_px;  // negative: the builder's word for an em
}

ImVector<ImWchar> ranges_of(std::span<const ImWchar> letters, bool always) {
  ImFontGlyphRangesBuilder builder;
  for (const ImWchar letter : letters) builder.AddChar(letter);
  if (always) builder.AddRanges(kAlways.data());
  ImVector<ImWchar> ranges;
  builder.BuildRanges(&ranges);
  return ranges;
}

bool has(const ImFontAtlas& atlas, ImWchar letter) {
  return !atlas.Fonts.empty() && atlas.Fonts.front()->FindGlyphNoFallback(letter) != nullptr;
}

/// Gives a font those of the letters that it has, and returns the others. Builds a small atlas, so that a font that
/// ImGui cannot read spoils no text.
std::vector<ImWchar> give_letters(PanelFont& font, std::vector<ImWchar> letters) {
  if (letters.empty() || font.bytes.empty()) return letters;
  ImFontAtlas atlas;
  atlas.AddFontDefault();
  const ImVector<ImWchar> ranges = ranges_of(letters, false);
  add_font(atlas, font, kDefaultText_px, ranges);
  if (!atlas.Build()) return font.bytes.clear(), letters;
  const auto lacking =
      std::stable_partition(letters.begin(), letters.end(), [&](ImWchar letter) { return has(atlas, letter); });
  if (letters.begin() != lacking) all().newest = letters.front();
  font.letters.insert(font.letters.end(), letters.begin(), lacking);
  return {lacking, letters.end()};
}

/// Returns the place of the system's font for a letter among the fonts; nothing if there is none.
std::optional<std::size_t> find_font(ImWchar letter) {
  std::optional<FontSearch>& search = all().search;
  std::vector<PanelFont>& fonts = all().fonts;
  if (!search) search.emplace();
  const std::optional<FontFace> face = search->find(letter);
  if (!face) return std::nullopt;
  const auto known = std::ranges::find(fonts, *face, &PanelFont::face);
  const auto place = static_cast<std::size_t>(known - fonts.begin());
  if (known == fonts.end()) fonts.push_back(read_font(*face));
  return place;
}

/// Finds the fonts of the waiting letters.
void search_fonts() {
  std::vector<PanelFont>& fonts = all().fonts;
  std::vector<std::vector<ImWchar>> found(fonts.size());
  for (const ImWchar letter : give_letters(fonts.front(), std::exchange(all().waiting, {}))) {
    const std::optional<std::size_t> font = find_font(letter);
    found.resize(fonts.size());
    if (font) found[*font].push_back(letter);
  }
  for (std::size_t k = 0; k < found.size(); ++k) give_letters(fonts[k], std::move(found[k]));
}

/// Reads DejaVu Sans once. A damaged installation has ImGui's own font.
void read_first_font() {
  if (!all().fonts.empty()) return;
  try {
    all().fonts.push_back(read_font({data_file("DejaVuSans.ttf").string()}));
  } catch (const BrokenInstallation&) {
    all().fonts.emplace_back();
  }
}

void add_first_font(ImFontAtlas& atlas, float scale, const ImVector<ImWchar>& ranges) {
  PanelFont& first = all().fonts.front();
  if (!first.bytes.empty()) return add_font(atlas, first, kText_px * scale, ranges);
  ImFontConfig config;
  config.SizePixels = kDefaultText_px * scale;
  atlas.AddFontDefault(&config);
}

}  // namespace

void load_panel_fonts(float scale) {
  read_first_font();
  search_fonts();
  std::vector<PanelFont>& fonts = all().fonts;
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  std::vector<ImVector<ImWchar>> ranges;
  ranges.reserve(fonts.size());
  for (const PanelFont& font : fonts) ranges.push_back(ranges_of(font.letters, &font == &fonts.front()));
  add_first_font(atlas, scale, ranges.front());
  for (std::size_t k = 1; k < fonts.size(); ++k) {
    if (!fonts[k].letters.empty()) add_font(atlas, fonts[k], kText_px * scale, ranges[k]);
  }
  atlas.Build();
  atlas.ClearInputData();  // the ranges end here
}

std::string panel_text(std::string_view utf8) {
  std::string text;
  for (std::size_t from = 0; from <= utf8.size();) {
    const std::size_t to = std::min(utf8.find('\n', from), utf8.size());
    text.append(from > 0 ? "\n" : "").append(visual_text(utf8.substr(from, to - from)));
    from = to + 1;
  }
  want_letters(text);
  return text;
}

void want_letters(std::string_view utf8) {
  if (std::ranges::all_of(utf8, [](char c) { return static_cast<unsigned char>(c) < 0x80U; })) return;
  PanelLetters& letters = all();
  for (const char32_t letter : code_points(utf8)) {
    if (letter < 0x80 || letter > kLastLetter || is_always_there(letter)) continue;
    if (letters.known.size() >= kMostLetters || !letters.known.insert(letter).second) continue;
    letters.waiting.push_back(static_cast<ImWchar>(letter));
  }
}

bool letters_wait() {
  const PanelLetters& letters = all();
  return !letters.waiting.empty() || (letters.newest && !has(*ImGui::GetIO().Fonts, *letters.newest));
}

}  // namespace terrella
