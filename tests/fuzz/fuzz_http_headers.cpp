#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "streaming/http/http_address.h"
#include "streaming/http/http_headers.h"

namespace {

using namespace terrella::http;

constexpr std::int64_t kNow_s = 1'700'000'000;

void check(bool holds) {
  if (!holds) std::abort();
}

void read_all(std::string_view text) {
  ReplyFields fields;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::size_t size = end == std::string_view::npos ? text.size() : end + 1;
    read_field_line(text.substr(0, size), fields);
    text.remove_prefix(size);
  }
  for (const std::string* value : {&fields.content_type, &fields.etag, &fields.last_modified}) {
    check(value->size() <= ReplyFields::kMaxValueBytes && is_field_value(*value));
  }
  if (const auto expiry_s = expiry_unix_s(fields, kNow_s)) {
    check(*expiry_s >= kNow_s - ReplyFields::kForever_s && *expiry_s <= kNow_s + ReplyFields::kForever_s);
  }
  if (const auto wait = retry_after(fields, kNow_s)) {
    check(wait->count() > 0 && wait->count() <= ReplyFields::kForever_s);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  read_all(text);
  if (check_request_header(text).ok()) check(text.find_first_of(std::string_view("\r\n\0", 3)) == std::string::npos);
  if (const auto address = parse_http_address(text)) check(is_field_value(shown(*address)));
  return 0;
}
