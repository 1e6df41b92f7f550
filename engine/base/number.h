#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace terrella {

/// Reads a finite decimal number. Blanks around the number are allowed. Refuses everything else: "nan", "inf",
/// hexadecimal, units, and numbers that overflow or underflow a double. The decimal point is '.' in every locale.
/// thread: any
[[nodiscard]] std::optional<double> read_number(std::string_view text);

/// Returns text without the blanks at both ends. A blank is a space, a tab or a line end. thread: any
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Splits text at its commas and removes the blanks around each piece. Returns at least one piece. thread: any
[[nodiscard]] std::vector<std::string_view> split_at_commas(std::string_view text);

/// Puts text into double quotes for an error message. Shortens long text and shows control characters as '?'.
/// thread: any
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace terrella
