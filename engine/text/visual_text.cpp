#include "text/visual_text.h"

#include <fribidi.h>

#include <algorithm>
#include <vector>

#include "base/code_points.h"

namespace terrella {

std::string visual_text(std::string_view utf8) {
  // Hebrew, the first script from right to left, begins at U+0590: bytes D6 90.
  const auto may_be_turned = [](char byte) { return static_cast<unsigned char>(byte) >= 0xD6U; };
  if (std::ranges::none_of(utf8, may_be_turned)) return std::string(utf8);
  const std::u32string points = code_points(utf8);
  const std::vector<FriBidiChar> characters(points.begin(), points.end());
  const auto count = static_cast<FriBidiStrIndex>(characters.size());
  std::vector<FriBidiChar> seen(characters.size() + 1);
  FriBidiParType direction = FRIBIDI_PAR_ON;
  if (fribidi_log2vis(characters.data(), count, &direction, seen.data(), nullptr, nullptr, nullptr) == 0) {
    return std::string(utf8);  // out of memory
  }
  // Signs of direction, joiners, and the mark that FriBidi leaves where two letters became one have no picture.
  const FriBidiStrIndex shown = fribidi_remove_bidi_marks(seen.data(), count, nullptr, nullptr, nullptr);
  std::vector<char> text(4 * seen.size());
  const FriBidiStrIndex bytes =
      fribidi_unicode_to_charset(FRIBIDI_CHAR_SET_UTF8, seen.data(), std::max(shown, 0), text.data());
  return {text.data(), static_cast<std::size_t>(bytes)};
}

}  // namespace terrella
