#pragma once

#include <string>
#include <string_view>

namespace terrella {

/// Returns the code points of a UTF-8 text, with U+FFFD for each byte that does not begin a code point. thread: any
[[nodiscard]] std::u32string code_points(std::string_view utf8);

}  // namespace terrella
