#include "streaming/remote/web_address.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace terrella {
namespace {

struct CleanUp {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
  void operator()(char* text) const { curl_free(text); }
};

std::string part(CURLU* url, CURLUPart which) {
  char* text = nullptr;
  if (curl_url_get(url, which, &text, 0) != CURLUE_OK) return {};
  const std::unique_ptr<char, CleanUp> owner(text);
  return text;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (lower(c) >= 'a' && lower(c) <= 'z') ||
         std::string_view("-._~:,").find(c) != std::string_view::npos;
}

void append_encoded(std::string& text, char c) {
  fmt::format_to(std::back_inserter(text), "%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
}

}  // namespace

std::optional<WebAddress> parse_address(const Url& url) {
  const std::unique_ptr<CURLU, CleanUp> parsed(curl_url());
  if (!parsed ||
      curl_url_set(parsed.get(), CURLUPART_URL, url.with_secrets().c_str(), CURLU_NON_SUPPORT_SCHEME) != CURLUE_OK) {
    return std::nullopt;
  }
  WebAddress address{.scheme = lower_case(part(parsed.get(), CURLUPART_SCHEME)),
                     .host = lower_case(part(parsed.get(), CURLUPART_HOST)),
                     .path = part(parsed.get(), CURLUPART_PATH)};
  if (address.host.ends_with('.')) address.host.pop_back();
  return address;
}

bool has_scheme(std::string_view text) {
  const std::size_t end = text.find("://");
  return end != std::string_view::npos && end > 0 && end <= 16 &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end),
                     [](char c) { return is_plain(c) || c == '+'; });
}

bool is_from_network(const Url& address) {
  const std::string lowered = lower_case(address.with_secrets().substr(0, 8));
  return lowered.starts_with("http://") || lowered.starts_with("https://");
}

bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

std::string lower_case(std::string_view text) {
  std::string lowered(text);
  std::ranges::transform(lowered, lowered.begin(), lower);
  return lowered;
}

std::string percent_encode(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    if (is_plain(c)) {
      encoded += c;
    } else {
      append_encoded(encoded, c);
    }
  }
  return encoded;
}

std::string percent_decode(std::string_view text) {
  int length = 0;
  const std::unique_ptr<char, CleanUp> decoded(
      curl_easy_unescape(nullptr, text.data(), static_cast<int>(std::min<std::size_t>(text.size(), 1 << 20)), &length));
  return decoded ? std::string(decoded.get(), static_cast<std::size_t>(length)) : std::string(text);
}

std::string encode_braces(std::string_view url) {
  std::string encoded;
  for (const char c : url) {
    if (c == '{' || c == '}') {
      append_encoded(encoded, c);
    } else {
      encoded += c;
    }
  }
  return encoded;
}

}  // namespace terrella
