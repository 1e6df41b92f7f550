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

/// Writes printable(text) to standard output.
void write_result(std::string_view text);
/// Writes printable(text) to standard error, its addresses redacted, all lines but the first indented: a line that a
/// file's name brought with it does not look like a message of the program's own.
void write_message(std::string_view text);

/// Print a result on standard output, a message on standard error. Every subcommand prints by these two alone.
template <class... Args>
void print_result(fmt::format_string<Args...> format, Args&&... args) {
  write_result(fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void print_message(fmt::format_string<Args...> format, Args&&... args) {
  write_message(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace terrella
