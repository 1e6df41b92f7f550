#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace terrella {

/// The address of something on the network, or the path of a file, as the user or a document gave it. An address may
/// hold secrets, so no print function takes a Url: its text leaves it redacted, or by with_secrets(). Secret are user
/// and password, the fragment, and each value of the query but those that WMTS and WMS define. thread: any
class Url {
 public:
  Url() = default;
  Url(std::string text) : text_(std::move(text)) {}
  Url(const char* text) : text_(text) {}

  [[nodiscard]] bool empty() const { return text_.empty(); }
  /// The whole text: for the code that opens the file or asks the server, and for nothing that a person may read.
  [[nodiscard]] const std::string& with_secrets() const { return text_; }
  /// For messages and reports: "https://host/path?LAYER=a&token=***". A path is shown as it is.
  [[nodiscard]] std::string redacted() const;
  /// For names: redacted, and without the query.
  [[nodiscard]] std::string without_query() const;
  bool operator==(const Url&) const = default;

 private:
  std::string text_;
};

/// Text for people in which each http and https address is redacted as a Url is: for messages that repeat what the user
/// typed, whatever it is. thread: any
[[nodiscard]] std::string redact_addresses(std::string_view text);

}  // namespace terrella
