#include "streaming/other_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace terrella {

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._/+-:=,@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

namespace {

using namespace std::string_view_literals;

/// A format that GDAL reads with some builds alone, and the program that makes a PNG of it.
struct FormatStart {
  const char* name;
  std::string_view bytes;
  std::size_t at;
  const char* program;
};
constexpr std::array kFormats = {
    FormatStart{"JPEG XL", "\0\0\0\x0cJXL "sv, 0, "djxl"},
    FormatStart{"JPEG XL", "\xff\x0a"sv, 0, "djxl"},
    FormatStart{"AVIF", "ftypavif"sv, 4, "convert"},
};

}  // namespace

std::string convert_hint(const std::filesystem::path& path, std::string_view head) {
  const auto* const format = std::ranges::find_if(kFormats, [head](const FormatStart& start) {
    return head.size() >= start.at && head.substr(start.at).starts_with(start.bytes);
  });
  if (format == kFormats.end()) return {};
  const std::string png = (path.parent_path() / path.stem()).string() + ".png";
  return fmt::format("it is {}; make a picture of it that is read: {} {} {}", format->name, format->program,
                     shell_word(path.string()), shell_word(png));
}

}  // namespace terrella
