#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace terrella {

/// Text as a finite decimal number; blanks around it are allowed, nothing else is: no "nan", "inf", hexadecimal, units,
/// and nothing that overflows or underflows a double. The decimal point is '.' whatever the locale. thread: any
[[nodiscard]] std::optional<double> read_number(std::string_view text);

/// The pieces between commas, blanks around each removed; always at least one.
[[nodiscard]] std::vector<std::string_view> split_at_commas(std::string_view text);

/// Text in double quotes for an error message: shortened if it is long, control characters shown as '?'.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace terrella
