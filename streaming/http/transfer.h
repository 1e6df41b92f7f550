#pragma once

#include <curl/curl.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "streaming/http/http_fetcher.h"
#include "streaming/http/http_headers.h"
#include "streaming/http/retry_policy.h"

namespace terrella::http {

/// A curl easy handle and the answer that it receives. The constructor sets the options common to all requests, and
/// begin() the others, so that handles are reused. thread: network
class Transfer {
 public:
  /// Request of one attempt.
  struct Question {
    const Url* url = nullptr;
    const std::vector<std::string>* headers = nullptr;  ///< already checked; null: none
    std::string_view etag;
    std::string_view last_modified;
    std::string_view if_match;
    std::optional<ByteRange> range;
    bool wait_for_multiplexing = false;  ///< waits for a multiplexed connection instead of opening another
  };

  /// Throws std::bad_alloc if curl cannot create a handle.
  explicit Transfer(const HttpOptions& options);
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  void begin(const Question& question);
  /// Call after curl reports the end of the transfer.
  [[nodiscard]] Answer answer(CURLcode code);
  /// Fault of the server's certificate, for people; empty if the certificate was not the problem.
  [[nodiscard]] std::string_view certificate_fault() const { return certificate_fault_; }
  [[nodiscard]] const ReplyFields& fields() const { return fields_; }
  [[nodiscard]] std::vector<std::byte> take_body() { return std::move(body_); }
  [[nodiscard]] Url redirect_url() const;  ///< absolute; empty: none
  [[nodiscard]] bool multiplexed() const;
  [[nodiscard]] CURL* handle() const { return handle_.get(); }

 private:
  struct ListFree {
    void operator()(curl_slist* list) const { curl_slist_free_all(list); }
  };
  struct HandleFree {
    void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  };

  void set_limits(const HttpOptions& options);
  void add_header(const std::string& line);
  void set_range(const Question& question);
  [[nodiscard]] bool range_fits() const;
  [[nodiscard]] bool take(std::string_view bytes);
  [[nodiscard]] bool take_of_content(std::string_view bytes);
  [[nodiscard]] long status() const;
  static std::size_t on_body(char* bytes, std::size_t size, std::size_t count, void* self);
  static std::size_t on_header(char* bytes, std::size_t size, std::size_t count, void* self);

  const std::size_t max_body_bytes_;
  std::vector<char> details_ = std::vector<char>(CURL_ERROR_SIZE, '\0');
  std::unique_ptr<CURL, HandleFree> handle_;
  std::unique_ptr<curl_slist, ListFree> headers_;
  ReplyFields fields_;
  std::vector<std::byte> body_;
  std::size_t error_body_bytes_ = 0;
  std::string_view certificate_fault_;
  bool conditional_ = false;
  std::optional<ByteRange> range_;
  Cut cut_ = Cut::none;
};

}  // namespace terrella::http
