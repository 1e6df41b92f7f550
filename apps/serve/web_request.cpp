#include "apps/serve/web_request.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "base/number.h"
#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max();

/// Reads digits. A number too large for 64 bits is the largest one.
std::optional<std::uint64_t> read_position(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789") != text.npos) return std::nullopt;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} ? number : kEndless;
}

AskedRange part(std::uint64_t first, std::uint64_t last, std::uint64_t file_bytes) {
  if (first >= file_bytes) return {.kind = AskedRange::Kind::beyond};
  return {.kind = AskedRange::Kind::part,
          .range = {.offset = first, .length = std::min(last, file_bytes - 1) - first + 1}};
}

}  // namespace

bool is_plain_in_addresses(char c) {
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return letter || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
}

std::map<std::string, std::string> read_query(std::string_view query) {
  constexpr int kMostKeys = 64;
  std::map<std::string, std::string> values;
  for (int i = 0; i < kMostKeys && !query.empty(); ++i) {
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
    const std::size_t equals = std::min(pair.find('='), pair.size());
    const std::string_view value = pair.substr(std::min(equals + 1, pair.size()));
    // percent_decode() takes an empty text for one without a known length.
    values.emplace(lower_case(pair.substr(0, equals)), value.empty() ? std::string() : percent_decode(value));
  }
  return values;
}

std::int64_t read_count(std::string_view text) {
  constexpr std::size_t kMostDigits = 15;
  const bool padded = text.size() > 1 && text.front() == '0';
  if (padded || text.size() > kMostDigits) return -1;
  const auto number = read_position(text);
  return number ? static_cast<std::int64_t>(*number) : -1;
}

AskedRange asked_range(std::string_view header, std::uint64_t file_bytes) {
  constexpr std::string_view kUnit = "bytes=";
  header = trimmed(header);
  if (!same_letters(header.substr(0, kUnit.size()), kUnit)) return {};
  header.remove_prefix(kUnit.size());
  const std::size_t dash = header.find('-');
  if (dash == header.npos) return {};
  const std::string_view from = trimmed(header.substr(0, dash)), to = trimmed(header.substr(dash + 1));
  const auto first = read_position(from), last = read_position(to);
  if (from.empty() && last) {
    return *last == 0 ? AskedRange{.kind = AskedRange::Kind::beyond}
                      : part(file_bytes - std::min(*last, file_bytes), kEndless, file_bytes);
  }
  if (first && to.empty()) return part(*first, kEndless, file_bytes);
  if (!first || !last || *last < *first) return {};
  return part(*first, *last, file_bytes);
}

bool names_etag(std::string_view header, std::string_view etag) {
  while (!header.empty()) {
    const std::string_view item = header.substr(0, header.find(','));
    header.remove_prefix(std::min(item.size() + 1, header.size()));
    std::string_view name = trimmed(item);
    if (name.starts_with("W/")) name.remove_prefix(2);
    if (name == "*" || name == etag) return true;
  }
  return false;
}

}  // namespace terrella
