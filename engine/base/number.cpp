#include "base/number.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace terrella {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<double> read_number(std::string_view text) {
  const std::string_view digits = trimmed(text);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  // from_chars accepts "nan" and "inf", and stops at the first character that it cannot use.
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> pieces;
  for (std::size_t comma = text.find(','); comma != std::string_view::npos; comma = text.find(',')) {
    pieces.push_back(trimmed(text.substr(0, comma)));
    text.remove_prefix(comma + 1);
  }
  pieces.push_back(trimmed(text));
  return pieces;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 80;
  std::string shown(text.substr(0, longest));
  for (char& c : shown) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) c = '?';
  }
  return '"' + shown + (text.size() > longest ? "…\"" : "\"");
}

}  // namespace terrella
