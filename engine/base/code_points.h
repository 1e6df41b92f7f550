#pragma once

#include <string>
#include <string_view>

namespace terrella {

/// True for a byte of UTF-8 that goes on with the character before it. thread: any
[[nodiscard]] constexpr bool is_within_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

/// Returns the code points of a UTF-8 text, with U+FFFD for each byte that does not begin a code point. thread: any
[[nodiscard]] std::u32string code_points(std::string_view utf8);

}  // namespace terrella
