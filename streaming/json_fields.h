#pragma once

#include <fmt/format.h>

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geo/coordinates.h"

namespace terrella {

inline constexpr std::size_t kMaxJsonTextBytes = 16384;

/// Parses text that must hold one JSON object of at most `max_bytes`. Error messages begin with `where`. thread: any
[[nodiscard]] Result<nlohmann::json> parse_json_object(std::string_view text, std::size_t max_bytes,
                                                       const std::string& where);

/// Reads the fields of one JSON object. Keeps the first error, which names `where` and the field. Treats a null field
/// as missing. Both constructor arguments must outlive this object. thread: one
class JsonFields {
 public:
  JsonFields(const nlohmann::json& object, const std::string& where) : object_(object), where_(where) {}

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  [[nodiscard]] bool has(const char* field) const;
  std::string text(const char* field);  ///< empty if the field is missing
  /// Returns `otherwise` if the field is missing. Without `otherwise` the field is required.
  int integer(const char* field, std::optional<int> otherwise);
  double number(const char* field);  ///< required
  /// Returns `otherwise` if the field is missing. A null is refused.
  bool flag(const char* field, bool otherwise);
  /// Reads one of a few words and returns its index among them.
  int choice(const char* field, std::span<const char* const> words, std::optional<int> otherwise);
  /// Reads one of two words, as 0 or 1.
  int choice(const char* field, const char* first, const char* second, std::optional<int> otherwise);
  GeoRect bounds(const char* field);                       ///< degrees; the whole planet if the field is missing
  std::vector<std::string> texts(const char* field);       ///< empty if the field is missing
  void refuse_others(std::span<const char* const> known);  ///< reports an error for any other field

  template <class T>
  T fail(const char* field, const std::string& what) {
    if (!error_) error_ = Error{fmt::format("{}: the field \"{}\" {}", where_, field, what)};
    return T{};
  }

 private:
  const nlohmann::json* find(const char* field, bool required);

  const nlohmann::json& object_;
  const std::string& where_;
  std::optional<Error> error_;
};

}  // namespace terrella
