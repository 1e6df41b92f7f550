#include "base/code_points.h"

#include <bit>
#include <cstddef>

namespace terrella {
namespace {

constexpr char32_t kNotACharacter = 0xFFFD;

}  // namespace

std::u32string code_points(std::string_view utf8) {
  std::u32string points;
  for (std::size_t k = 0; k < utf8.size();) {
    const auto first = static_cast<unsigned char>(utf8[k]);
    const auto length = static_cast<std::size_t>(std::countl_one(first));
    char32_t point = length == 0 ? first : first & (0x7FU >> length);
    std::size_t read = 1;
    for (; read < length && k + read < utf8.size(); ++read) {
      const char next = utf8[k + read];
      if (!is_within_character(next)) break;
      point = point << 6U | (static_cast<unsigned char>(next) & 0x3FU);
    }
    const bool is_character = point <= 0x10FFFF && (point < 0xD800 || point > 0xDFFF);
    const bool whole = length == 0 || (length >= 2 && length <= 4 && read == length && is_character);
    points.push_back(whole ? point : kNotACharacter);
    k += whole ? read : 1;
  }
  return points;
}

}  // namespace terrella
