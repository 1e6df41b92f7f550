#include "apps/process/console.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "apps/process/option_names.h"
#include "base/code_points.h"

namespace terrella {
namespace {

constexpr char32_t kNotUtf8 = 0xFFFD;

ConsoleSink g_sink;  // empty unless a CapturedConsole exists

bool acts_on_a_terminal(char32_t c) {
  const bool control = c < 0x20 || (c >= 0x7F && c <= 0x9F);
  const bool line_separator = c == 0x2028 || c == 0x2029;
  const bool direction = (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
  return control || line_separator || direction;
}

std::size_t needed_bytes(char32_t c) { return c < 0x80 ? 1 : c < 0x800 ? 2 : c < 0x10000 ? 3 : 4; }

/// Length of a character by its first byte.
std::size_t written_bytes(char first) {
  return static_cast<std::size_t>(std::max(1, std::countl_one(static_cast<unsigned char>(first))));
}

std::string escaped(std::string_view text, std::string_view kept) {
  constexpr std::string_view kReplacement = "\uFFFD";
  std::string shown;
  for (const char32_t c : code_points(text)) {
    const bool broken = c == kNotUtf8 && !text.starts_with(kReplacement);
    const std::size_t bytes = broken ? 1 : written_bytes(text.front());
    if (broken || bytes != needed_bytes(c)) {  // overlong encodings could bypass filters
      shown += kReplacement;
    } else if (acts_on_a_terminal(c) && kept.find(text.front()) == std::string_view::npos) {
      shown += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      shown += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return shown;
}

}  // namespace

std::string printable(std::string_view text) { return escaped(text, "\n\t"); }

std::string one_line(std::string_view text) { return escaped(text, ""); }

CapturedConsole::CapturedConsole(ConsoleSink sink) { g_sink = std::move(sink); }

CapturedConsole::~CapturedConsole() { g_sink = {}; }

bool CapturedConsole::active() { return g_sink.message != nullptr; }

void write_result(std::string_view text) {
  const std::string shown = printable(text);
  if (CapturedConsole::active()) return g_sink.result(shown);
  std::fwrite(shown.data(), 1, shown.size(), stdout);
}

void write_message(std::string_view text) {
  std::string shown = escaped(shown_message(text), "\n");
  if (CapturedConsole::active()) return g_sink.message(shown);
  for (std::size_t end = shown.find('\n'); end < shown.size() - 1; end = shown.find('\n', end + 1)) {
    shown.insert(end + 1, "  ");
  }
  std::fwrite(shown.data(), 1, shown.size(), stderr);
}

}  // namespace terrella
