#include "streaming/http/http_headers.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "base/number.h"

namespace terrella::http {
namespace {

constexpr std::size_t kMaxHeaderBytes = 8192;  // most servers accept no more

// std::tolower would use the locale.
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same_name(std::string_view name, std::string_view lower_case) {
  return name.size() == lower_case.size() &&
         std::equal(name.begin(), name.end(), lower_case.begin(), [](char a, char b) { return lower(a) == b; });
}

/// A whole number of seconds, at most kForever_s; none unless the text has only digits.
std::optional<std::int64_t> seconds_of(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  std::int64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc()) return ReplyFields::kForever_s;
  return std::min(value, ReplyFields::kForever_s);
}

std::optional<std::int64_t> date_of(std::string_view text) {
  if (text.size() > 64) return std::nullopt;
  const time_t date = curl_getdate(std::string(text).c_str(), nullptr);
  if (date < 0) return std::nullopt;
  return static_cast<std::int64_t>(date);
}

/// End of the list's first element: a comma outside quotes.
std::size_t element_end(std::string_view list) {
  bool quoted = false;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (quoted && list[i] == '\\') {
      ++i;
    } else if (list[i] == '"') {
      quoted = !quoted;
    } else if (list[i] == ',' && !quoted) {
      return i;
    }
  }
  return list.size();
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

void read_directive(std::string_view directive, ReplyFields& fields) {
  const std::size_t equals = directive.find('=');
  const std::string_view name = trimmed(directive.substr(0, equals));
  if (same_name(name, "no-store")) fields.no_store = true;
  if (same_name(name, "no-cache")) fields.no_cache = true;
  if (!same_name(name, "max-age") || equals == std::string_view::npos) return;
  const std::int64_t age = seconds_of(unquoted(trimmed(directive.substr(equals + 1)))).value_or(0);
  // The shorter of two values counts, because extra requests do less harm.
  fields.max_age_s = std::min(age, fields.max_age_s.value_or(age));
}

void read_cache_control(std::string_view list, ReplyFields& fields) {
  while (!list.empty()) {
    const std::size_t end = element_end(list);
    read_directive(list.substr(0, end), fields);
    list.remove_prefix(std::min(end + 1, list.size()));
  }
}

void keep_text(std::string_view value, std::string& text) {
  if (value.size() <= ReplyFields::kMaxValueBytes && is_field_value(value)) text.assign(value);
}

void read_field(std::string_view name, std::string_view value, ReplyFields& fields) {
  if (same_name(name, "cache-control")) {
    read_cache_control(value, fields);
  } else if (same_name(name, "content-type")) {
    keep_text(value, fields.content_type);
  } else if (same_name(name, "etag")) {
    keep_text(value, fields.etag);
  } else if (same_name(name, "last-modified")) {
    keep_text(value, fields.last_modified);
  } else if (same_name(name, "expires")) {
    fields.expires_unix_s = date_of(value).value_or(0);
  } else if (same_name(name, "date")) {
    fields.date_unix_s = date_of(value);
  } else if (same_name(name, "age")) {
    fields.age_s = seconds_of(value);
  } else if (same_name(name, "content-range")) {
    fields.content_range = parse_content_range(value);
  } else if (same_name(name, "retry-after")) {
    fields.retry_after_s = seconds_of(value);
    if (!fields.retry_after_s) fields.retry_at_unix_s = date_of(value);
  }
}

bool is_token_char(char c) {
  return (c >= '0' && c <= '9') || (lower(c) >= 'a' && lower(c) <= 'z') ||
         std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

/// Reads digits from the front of a text; none if there are no digits or too many.
std::optional<std::uint64_t> take_number(std::string_view& text) {
  std::uint64_t number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take_char(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::optional<ContentRange> parse_content_range(std::string_view value) {
  constexpr std::string_view kUnit = "bytes";
  if (!same_name(value.substr(0, kUnit.size()), kUnit)) return std::nullopt;
  std::string_view rest = trimmed(value.substr(std::min(kUnit.size(), value.size())));
  const auto first = take_number(rest);
  if (!first || !take_char(rest, '-')) return std::nullopt;
  const auto last = take_number(rest);
  if (!last || *last < *first || *last - *first == ~std::uint64_t{0} || !take_char(rest, '/')) return std::nullopt;
  ContentRange range{.bytes = {.offset = *first, .length = *last - *first + 1}, .file_bytes = {}};
  if (rest == "*") return range;
  range.file_bytes = take_number(rest);
  if (!range.file_bytes || !rest.empty() || *last >= *range.file_bytes) return std::nullopt;
  return range;
}

void ReplyFields::clear() {
  for (std::string* text : {&content_type, &etag, &last_modified}) text->clear();
  for (auto* number : {&max_age_s, &age_s, &expires_unix_s, &date_unix_s, &retry_after_s, &retry_at_unix_s}) {
    number->reset();
  }
  content_range.reset();
  no_store = no_cache = false;
  bytes = 0;
}

void read_field_line(std::string_view line, ReplyFields& fields) {
  const std::size_t bytes = fields.bytes + line.size();
  if (line.starts_with("HTTP/")) {
    fields.clear();
  } else if (const std::size_t colon = line.find(':'); colon != std::string_view::npos) {
    read_field(line.substr(0, colon), trimmed(line.substr(colon + 1)), fields);
  }
  fields.bytes = bytes;
}

std::optional<std::int64_t> expiry_unix_s(const ReplyFields& fields, std::int64_t now_unix_s) {
  if (fields.no_cache || fields.no_store) return now_unix_s;
  const std::int64_t age_s = fields.age_s.value_or(0);
  if (fields.max_age_s) return now_unix_s + *fields.max_age_s - age_s;
  if (!fields.expires_unix_s) return std::nullopt;
  const std::int64_t life_s = *fields.expires_unix_s - fields.date_unix_s.value_or(now_unix_s);
  return now_unix_s + std::clamp<std::int64_t>(life_s, 0, ReplyFields::kForever_s) - age_s;
}

std::optional<std::chrono::seconds> retry_after(const ReplyFields& fields, std::int64_t now_unix_s) {
  std::int64_t wait_s = 0;
  if (fields.retry_after_s) {
    wait_s = *fields.retry_after_s;
  } else if (fields.retry_at_unix_s) {
    wait_s = std::min(*fields.retry_at_unix_s - fields.date_unix_s.value_or(now_unix_s), ReplyFields::kForever_s);
  }
  if (wait_s <= 0) return std::nullopt;
  return std::chrono::seconds(wait_s);
}

bool is_field_value(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return (code < 0x20 && c != '\t') || code == 0x7F;
  });
}

Status check_request_header(std::string_view header) {
  constexpr std::array<std::string_view, 11> kOwn = {
      "host",          "user-agent",        "connection", "content-length", "transfer-encoding", "te", "if-match",
      "if-none-match", "if-modified-since", "range",      "upgrade"};
  const std::size_t colon = header.find(':');
  const std::string_view name = header.substr(0, colon);
  if (colon == std::string_view::npos || name.empty() || !std::all_of(name.begin(), name.end(), is_token_char)) {
    return Error{"a header is not of the form \"Name: value\""};
  }
  if (header.size() > kMaxHeaderBytes) {
    return Error{fmt::format("the header {} is longer than {} bytes", name, kMaxHeaderBytes)};
  }
  if (!is_field_value(header.substr(colon + 1))) {
    return Error{fmt::format("the header {} holds a line end or another control character: remove it", name)};
  }
  if (std::any_of(kOwn.begin(), kOwn.end(), [&](std::string_view own) { return same_name(name, own); })) {
    return Error{fmt::format("the header {} is set by Terrella itself for each request: leave it out", name)};
  }
  return Done{};
}

}  // namespace terrella::http
