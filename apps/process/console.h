#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace terrella {

/// Makes text from files and servers safe for a terminal. Control characters (C0 except line end and tab, DEL, C1),
/// Unicode line separators and direction marks become escapes such as "\u001b". Bytes that are not UTF-8 become U+FFFD.
/// JSON text keeps its meaning. thread: any
[[nodiscard]] std::string printable(std::string_view text);
/// Like printable(), but also escapes line ends and tabs. Use this for a name within a line of a report or list.
[[nodiscard]] std::string one_line(std::string_view text);

/// Takes the texts that the program would print: results, and messages with addresses redacted. thread: any that prints
struct ConsoleSink {
  std::function<void(const std::string& text)> result;
  std::function<void(const std::string& text)> message;
};

/// Sends all text to `sink` instead of the standard streams until this object ends; progress is then not shown. Only
/// one may exist at a time. thread: one that nothing prints beside
class CapturedConsole {
 public:
  explicit CapturedConsole(ConsoleSink sink);
  ~CapturedConsole();
  CapturedConsole(const CapturedConsole&) = delete;
  CapturedConsole& operator=(const CapturedConsole&) = delete;

  [[nodiscard]] static bool active();  ///< thread: any
};

/// Writes printable(text) to standard output.
void write_result(std::string_view text);
/// Writes printable(text) to standard error, with addresses redacted and tabs escaped. All lines but the first are
/// indented, so that a line break in a file's name cannot fake a message of the program.
void write_message(std::string_view text);

/// Print a result to standard output, or a message to standard error. Every subcommand prints through these two
/// functions only.
template <class... Args>
void print_result(fmt::format_string<Args...> format, Args&&... args) {
  write_result(fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void print_message(fmt::format_string<Args...> format, Args&&... args) {
  write_message(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace terrella
