#include "streaming/http/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

namespace terrella::http {
namespace {

// An error page is read to its end, so that the connection can be reused, unless the page is longer than this.
constexpr std::size_t kMaxErrorBody = 64 << 10;
// Most memory allocated for a Content-Length before the first byte.
constexpr curl_off_t kMaxReserve = 1 << 20;

long whole_seconds(std::chrono::milliseconds time) { return static_cast<long>((time.count() + 999) / 1000); }

}  // namespace

Transfer::Transfer(const HttpOptions& options)
    : max_body_bytes_(options.max_response_bytes), handle_(curl_easy_init()) {
  if (!handle_) throw std::bad_alloc();
  CURL* curl = handle_.get();
  curl_easy_setopt(curl, CURLOPT_PRIVATE, nullptr);
  curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, details_.data());
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_USERAGENT, "Terrella/" TERRELLA_VERSION);
  curl_easy_setopt(curl, CURLOPT_ACCEPT_ENCODING, "");
  curl_easy_setopt(curl, CURLOPT_SUPPRESS_CONNECT_HEADERS, 1L);
  curl_easy_setopt(curl, CURLOPT_HTTP_VERSION, options.http2 ? CURL_HTTP_VERSION_2TLS : CURL_HTTP_VERSION_1_1);
  if (!options.ca_file.empty()) {
    curl_easy_setopt(curl, CURLOPT_CAINFO, options.ca_file.c_str());
    curl_easy_setopt(curl, CURLOPT_CAPATH, nullptr);
  }
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, &Transfer::on_body);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, this);
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, &Transfer::on_header);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, this);
  set_limits(options);
}

void Transfer::set_limits(const HttpOptions& options) {
  CURL* curl = handle_.get();
  curl_easy_setopt(curl, CURLOPT_MAXFILESIZE_LARGE, static_cast<curl_off_t>(options.max_response_bytes));
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(options.connect_timeout.count()));
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(options.total_timeout.count()));
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, whole_seconds(options.stall_timeout));
}

void Transfer::begin(const Question& question) {
  fields_.clear();
  body_.clear();
  error_body_bytes_ = 0;
  cut_ = Cut::none;
  details_.front() = '\0';
  certificate_fault_ = {};
  conditional_ = !question.etag.empty() || !question.last_modified.empty();
  headers_.reset();
  if (question.headers != nullptr) {
    for (const std::string& line : *question.headers) add_header(line);
  }
  if (!question.etag.empty()) add_header("If-None-Match: " + std::string(question.etag));
  if (!question.last_modified.empty()) add_header("If-Modified-Since: " + std::string(question.last_modified));
  set_range(question);
  curl_easy_setopt(handle_.get(), CURLOPT_HTTPHEADER, headers_.get());
  curl_easy_setopt(handle_.get(), CURLOPT_URL, question.url->with_secrets().c_str());
  curl_easy_setopt(handle_.get(), CURLOPT_PIPEWAIT, question.wait_for_multiplexing ? 1L : 0L);
}

void Transfer::set_range(const Question& question) {
  range_ = question.range;
  std::string text;
  if (range_) text = fmt::format("{}-{}", range_->offset, range_->offset + range_->length - 1);
  curl_easy_setopt(handle_.get(), CURLOPT_RANGE, range_ ? text.c_str() : nullptr);
  // A range counts the bytes of the encoding that is sent, so that encoding must be the file itself.
  curl_easy_setopt(handle_.get(), CURLOPT_ACCEPT_ENCODING, range_ ? nullptr : "");
  if (!question.if_match.empty()) add_header("If-Match: " + std::string(question.if_match));
}

bool Transfer::range_fits() const {
  if (!range_ || !fields_.content_range) return false;
  const ContentRange& got = *fields_.content_range;
  const bool to_the_end = got.file_bytes == got.bytes.offset + got.bytes.length;
  const bool as_requested = got.bytes.length == range_->length || (got.bytes.length < range_->length && to_the_end);
  return got.bytes.offset == range_->offset && as_requested && body_.size() == got.bytes.length;
}

void Transfer::add_header(const std::string& line) {
  curl_slist* longer = curl_slist_append(headers_.get(), line.c_str());
  if (longer == nullptr) throw std::bad_alloc();
  static_cast<void>(headers_.release());
  headers_.reset(longer);
}

// Other texts from curl may contain an address with its query, or a proxy's password.
Answer Transfer::answer(CURLcode code) {
  if (code == CURLE_PEER_FAILED_VERIFICATION) certificate_fault_ = details_.data();
  return {.code = code,
          .status = static_cast<int>(status()),
          .conditional = conditional_,
          .ranged = range_.has_value(),
          .range_fits = range_fits(),
          .cut = cut_};
}

long Transfer::status() const {
  long status = 0;
  curl_easy_getinfo(handle_.get(), CURLINFO_RESPONSE_CODE, &status);
  return status;
}

Url Transfer::redirect_url() const {
  char* url = nullptr;
  curl_easy_getinfo(handle_.get(), CURLINFO_REDIRECT_URL, &url);
  return url == nullptr ? Url() : Url(url);
}

bool Transfer::multiplexed() const {
  long version = 0;
  curl_easy_getinfo(handle_.get(), CURLINFO_HTTP_VERSION, &version);
  return version >= CURL_HTTP_VERSION_2_0;
}

bool Transfer::take(std::string_view bytes) {
  const long code = status();
  const bool whole = code == 200 || code == 203;
  if (range_ ? code == 206 : whole) return take_of_content(bytes);
  // The whole file in place of a range may be huge.
  if (range_ && whole) error_body_bytes_ = kMaxErrorBody;
  error_body_bytes_ += bytes.size();
  if (error_body_bytes_ <= kMaxErrorBody) return true;
  cut_ = Cut::error_body;
  return false;
}

bool Transfer::take_of_content(std::string_view bytes) {
  if (bytes.size() > max_body_bytes_ - body_.size()) {
    cut_ = Cut::body_too_large;
    return false;
  }
  if (body_.capacity() == 0) {
    curl_off_t length = -1;
    curl_easy_getinfo(handle_.get(), CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &length);
    if (length > 0) body_.reserve(static_cast<std::size_t>(std::min(length, kMaxReserve)));
  }
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  body_.insert(body_.end(), begin, begin + bytes.size());
  return true;
}

// Exceptions must not pass through curl's frames.
std::size_t Transfer::on_body(char* bytes, std::size_t size, std::size_t count, void* self) {
  auto* transfer = static_cast<Transfer*>(self);
  try {
    return transfer->take({bytes, size * count}) ? size * count : CURL_WRITEFUNC_ERROR;
  } catch (const std::bad_alloc&) {
    transfer->cut_ = Cut::no_memory;
    return CURL_WRITEFUNC_ERROR;
  }
}

std::size_t Transfer::on_header(char* bytes, std::size_t size, std::size_t count, void* self) {
  auto* transfer = static_cast<Transfer*>(self);
  try {
    read_field_line({bytes, size * count}, transfer->fields_);
  } catch (const std::bad_alloc&) {
    transfer->cut_ = Cut::no_memory;
    return CURL_WRITEFUNC_ERROR;
  }
  if (transfer->fields_.bytes <= ReplyFields::kMaxBytes) return size * count;
  transfer->cut_ = Cut::headers_too_long;
  return CURL_WRITEFUNC_ERROR;
}

}  // namespace terrella::http
