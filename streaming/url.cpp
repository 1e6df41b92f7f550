#include "streaming/url.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace terrella {
namespace {

constexpr const char* kHidden = "***";
constexpr std::string_view kEndsSentence = ".,:;)";
constexpr std::string_view kEndsWord = " \t\n\"'<>";

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Finds `part`, which is in lower case, in a text of any case.
std::size_t find_letters(std::string_view text, std::string_view part, std::size_t from) {
  const auto begin = text.begin() + static_cast<std::ptrdiff_t>(std::min(from, text.size()));
  const auto found =
      std::search(begin, text.end(), part.begin(), part.end(), [](char a, char b) { return lower(a) == b; });
  return found == text.end() ? std::string_view::npos : static_cast<std::size_t>(found - text.begin());
}

/// Position of the host, or of user and password before it; npos for a path. Nobody writes a path that begins with
/// "http:", so that text is an address with a missing slash.
std::size_t authority_of(std::string_view text) {
  const std::size_t scheme = text.find("://");
  if (scheme != std::string_view::npos) return scheme + 3;
  if (find_letters(text.substr(0, 5), "http:", 0) != 0 && find_letters(text.substr(0, 6), "https:", 0) != 0) {
    return std::string_view::npos;
  }
  return std::min(text.find_first_not_of('/', text.find(':') + 1), text.size());
}

/// True if the text is a JSON description instead of its file's name.
bool is_json(std::string_view text) { return text.starts_with('{') && text.find('"') != std::string_view::npos; }

/// False if the text after the host's colon is no port. A password that contains "/", "?" or "#" looks like that.
bool has_good_port(std::string_view host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.find(':', bracket == std::string_view::npos ? 0 : bracket);
  return colon == std::string_view::npos || host.find_first_not_of("0123456789", colon + 1) == std::string_view::npos;
}

/// True if a host with a port may be a user and the begin of a password with "/": the path has an '@', and the host is
/// no name of the Internet.
bool may_be_user(std::string_view host, std::string_view path) {
  const bool is_name = host.find_first_of(".]") != std::string_view::npos || host.starts_with("localhost:");
  return !is_name && host.find(':') != std::string_view::npos && path.find('@') != std::string_view::npos;
}

/// Parameters of WMTS and WMS requests (OGC 07-057, 06-042) select the picture and are not secret.
bool is_public(std::string_view parameter) {
  constexpr std::string_view kPublic[] = {
      "service", "request",     "version",       "layer",      "layers",     "style",   "styles",
      "format",  "transparent", "tilematrixset", "tilematrix", "tilerow",    "tilecol", "time",
      "width",   "height",      "bbox",          "elevation",  "exceptions", "crs",     "srs"};
  return std::ranges::any_of(kPublic, [parameter](std::string_view known) {
    return parameter.size() == known.size() && find_letters(parameter, known, 0) == 0;
  });
}

std::string redacted_parameter(std::string_view parameter) {
  const std::size_t value = parameter.find('=');
  if (value == std::string_view::npos) return kHidden;
  const std::string_view name = parameter.substr(0, value);
  const std::string_view rest = parameter.substr(value + 1);
  const bool is_placeholder = rest.starts_with('{') && rest.find('}') + 1 == rest.size();
  return is_public(name) || is_placeholder ? std::string(parameter) : std::string(name) + "=" + kHidden;
}

/// Redacts "user:password@" and the values of parameters in a word that may be a part of an address taken for a path.
std::string redacted_path(std::string_view word) {
  std::string shown(word);
  if (const std::size_t host = shown.rfind('@'); host != std::string::npos) {
    const std::size_t scheme = shown.find(":/");
    const std::size_t user = scheme < host          ? shown.find_first_not_of('/', scheme + 1)
                             : shown.front() == '/' ? shown.rfind('/', host) + 1
                                                    : 0;
    if (shown.find(':', user) < host) shown.erase(user, host + 1 - user);
  }
  const std::string address = std::exchange(shown, {});
  const std::size_t ending = address.find_last_not_of(std::string(kEndsWord) + std::string(kEndsSentence)) + 1;
  std::size_t at = std::min(address.find('?'), ending);
  shown = address.substr(0, at);
  while (at < ending) {
    const std::size_t next = std::min(address.find_first_of("&;?", at + 1), ending);
    const std::string parameter = address.substr(at + 1, next - at - 1);
    shown += address[at] + (parameter.find('=') == std::string::npos ? parameter : redacted_parameter(parameter));
    at = next;
  }
  return shown + address.substr(ending);
}

/// Redacts a word with what ends it: an address of a server, or what was taken for a path.
std::string redacted_word(std::string_view word) {
  const std::size_t at = std::min(find_letters(word, "http", 0), word.size());
  const std::size_t end = word.find_last_not_of(std::string(kEndsWord) + std::string(kEndsSentence)) + 1;
  if (at >= end) return redacted_path(word);
  return redacted_path(word.substr(0, at)) + Url(std::string(word.substr(at, end - at))).redacted() +
         std::string(word.substr(end));
}

}  // namespace

std::string Url::without_query() const {
  if (is_json(text_)) return kHidden;
  const std::size_t authority = authority_of(text_);
  if (authority == std::string::npos) return text_;
  const std::string_view shown = std::string_view(text_).substr(0, text_.find_first_of("?#", authority));
  const std::size_t path = std::min(shown.find('/', authority), shown.size());
  std::string_view host = shown.substr(authority, path - authority);
  host.remove_prefix(host.rfind('@') + 1);
  const std::string scheme(shown.substr(0, authority));
  const bool is_host = has_good_port(host) && !may_be_user(host, shown.substr(path));
  return is_host ? scheme + std::string(host) + std::string(shown.substr(path)) : scheme + kHidden;
}

std::string Url::redacted() const {
  std::string shown = without_query();
  const std::size_t authority = authority_of(text_);
  if (authority == std::string::npos || shown.ends_with(kHidden)) return shown;
  const std::string_view address = std::string_view(text_).substr(0, text_.find('#', authority));
  for (std::size_t at = address.find('?', authority); at != std::string_view::npos;) {
    const std::size_t next = address.find_first_of("&;", at + 1);
    shown +=
        address[at] + redacted_parameter(address.substr(at + 1, next == std::string_view::npos ? next : next - at - 1));
    at = next;
  }
  return shown;
}

std::string redact_addresses(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(kEndsWord), text.size() - 1) + 1;
    shown += redacted_word(text.substr(0, end));
    text.remove_prefix(end);
  }
  return shown;
}

}  // namespace terrella
