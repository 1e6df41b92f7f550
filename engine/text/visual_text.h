#pragma once

#include <string>
#include <string_view>

namespace terrella {

/// Returns a line of UTF-8 text in the order in which its letters are seen from left to right, with Arabic letters in
/// the forms that they take beside their neighbours: for writers that place one letter after the other, without
/// shaping. Text without letters that run from right to left is returned as it is. thread: any
[[nodiscard]] std::string visual_text(std::string_view utf8);

}  // namespace terrella
