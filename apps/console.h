#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace terrella {

/// Text that a terminal only shows, whatever file or server it came from: control characters (C0 but line end and tab,
/// DEL, C1), the line separators of Unicode and those characters that turn the direction of writing become "\u001b",
/// bytes that are not UTF-8 become U+FFFD. JSON text keeps its meaning. thread: any
[[nodiscard]] std::string printable(std::string_view text);
/// The same without line ends and tabs: for a name that stands in a line of a report, or in a file of lines.
[[nodiscard]] std::string one_line(std::string_view text);

/// Writes printable(text). Text for standard error also has its addresses redacted. thread: any
void write_text(std::FILE* stream, std::string_view text);

/// Prints a result on standard output. Every subcommand prints by these two functions alone. thread: any
template <class... Args>
void print_result(fmt::format_string<Args...> format, Args&&... args) {
  write_text(stdout, fmt::format(format, std::forward<Args>(args)...));
}
/// Prints a message on standard error. thread: any
template <class... Args>
void print_message(fmt::format_string<Args...> format, Args&&... args) {
  write_text(stderr, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace terrella
