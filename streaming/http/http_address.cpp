#include "streaming/http/http_address.h"

#include <curl/curl.h>

#include <algorithm>
#include <memory>

namespace terrella::http {
namespace {

using UrlParts = std::unique_ptr<CURLU, decltype(&curl_url_cleanup)>;

std::string part(const UrlParts& url, CURLUPart which, unsigned flags = 0) {
  char* text = nullptr;
  if (curl_url_get(url.get(), which, &text, flags) != CURLUE_OK) return {};
  std::string copy(text);
  curl_free(text);
  return copy;
}

bool has_blank_or_control(const std::string& url) {
  return std::any_of(url.begin(), url.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code <= 0x20 || code == 0x7F;
  });
}

}  // namespace

Result<Address> parse_http_address(const Url& url) {
  const UrlParts parsed(curl_url(), &curl_url_cleanup);
  if (has_blank_or_control(url.with_secrets())) {
    return Error{"an address holds a blank, a line end or another control character: write it as %20 or remove it"};
  }
  if (!parsed ||
      curl_url_set(parsed.get(), CURLUPART_URL, url.with_secrets().c_str(), CURLU_NON_SUPPORT_SCHEME) != CURLUE_OK) {
    return Error{"an address cannot be read: write http://host/path, https://host/path or file:///path"};
  }
  const std::string scheme = part(parsed, CURLUPART_SCHEME);
  Address address;
  if (scheme == "file") {
    address = {Address::Scheme::file, "file://", part(parsed, CURLUPART_PATH, CURLU_URLDECODE)};
    if (address.path.empty()) return Error{"file: the path holds a control character"};
    return address;
  }
  std::string host = part(parsed, CURLUPART_HOST);
  std::transform(host.begin(), host.end(), host.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  if (scheme != "http" && scheme != "https") {
    return Error{scheme + "://" + host + ": only http, https and file are allowed"};
  }
  address.scheme = scheme == "https" ? Address::Scheme::https : Address::Scheme::http;
  address.origin = scheme + "://" + host + ":" + part(parsed, CURLUPART_PORT, CURLU_DEFAULT_PORT);
  address.path = part(parsed, CURLUPART_PATH);
  return address;
}

std::string shown(const Address& address) { return address.origin + address.path; }

}  // namespace terrella::http
