#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace terrella {

/// Builds a JSON document from the events of nlohmann's parser, in time linear in the length of the text. nlohmann's
/// own callback parser scans a whole array after each of its objects, which takes quadratic time.
/// Use: `nlohmann::json::sax_parse(text, &builder)`. thread: one
class JsonBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  enum class Problem { none, syntax, number, too_deep, too_much };
  struct Limits {
    std::size_t depth = 0;  ///< nesting: number of containers around a value
    /// Values, keys, and begins and ends of containers, counted since the last value that was dropped.
    std::size_t pieces = 0;
  };
  /// Called for each complete value with at most two containers around it. Returns true to keep the value. `member` is
  /// the current key of the document's outermost object.
  using Keep = std::function<bool(std::size_t depth, const std::string& member, nlohmann::json& value)>;

  explicit JsonBuilder(Limits limits, Keep keep = {}) : limits_(limits), keep_(std::move(keep)) {}

  /// The document. It is complete if sax_parse() returned true.
  [[nodiscard]] nlohmann::json& document() { return document_; }
  /// The reason why sax_parse() returned false: a syntax error at byte(), a number out of range, or a limit.
  [[nodiscard]] Problem problem() const { return problem_; }
  [[nodiscard]] std::size_t byte() const { return byte_; }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& value) override { return add(std::move(value)); }
  bool start_object(std::size_t) override { return open(nlohmann::json::object()); }
  bool start_array(std::size_t) override { return open(nlohmann::json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override;
  bool parse_error(std::size_t byte, const std::string& token, const nlohmann::json::exception& error) override;

 private:
  [[nodiscard]] bool count();
  [[nodiscard]] nlohmann::json* place(nlohmann::json value);
  bool add(nlohmann::json value);
  bool open(nlohmann::json container);
  bool close();
  bool complete(nlohmann::json& value);

  Limits limits_;
  Keep keep_;
  nlohmann::json document_;
  std::vector<nlohmann::json*> open_;  ///< open containers, outermost first
  std::string key_;                    ///< key of the value that follows
  std::string member_;                 ///< last key of the outermost object
  std::vector<std::string> keys_;      ///< keys of the open containers in their parents
  std::size_t pieces_ = 0;
  Problem problem_ = Problem::none;
  std::size_t byte_ = 0;
};

}  // namespace terrella
