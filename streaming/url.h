#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace terrella {

/// A network address or file path, as given by the user or by a document. An address may hold secrets, therefore no
/// print function accepts a Url: read the text redacted, or through with_secrets(). Secrets are user and password, the
/// fragment, and each query value except those that WMTS and WMS define. thread: any
class Url {
 public:
  Url() = default;
  Url(std::string text) : text_(std::move(text)) {}
  Url(const char* text) : text_(text) {}

  [[nodiscard]] bool empty() const { return text_.empty(); }
  /// The whole text, only for code that opens the file or asks the server. Never show this text to a person.
  [[nodiscard]] const std::string& with_secrets() const { return text_; }
  /// Text for messages and reports: "https://host/path?LAYER=a&token=***". A path stays unchanged.
  [[nodiscard]] std::string redacted() const;
  /// Text for names: redacted and without the query.
  [[nodiscard]] std::string without_query() const;
  bool operator==(const Url&) const = default;

 private:
  std::string text_;
};

/// Redacts each address in a text, as Url::redacted() does, also one that was taken for a path: one of any scheme, with
/// spaces or without a scheme ("user:password@host"). Use this for messages that repeat user input. thread: any
[[nodiscard]] std::string redact_addresses(std::string_view text);

}  // namespace terrella
