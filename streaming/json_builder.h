#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace terrella {

/// Builds a JSON document from nlohmann's parser, in time that grows with the text alone. The parser's own callbacks
/// look through a whole array after each of its objects, which takes the square of their number.
/// Use: `nlohmann::json::sax_parse(text, &builder)`. thread: one
class JsonBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  enum class Problem { none, syntax, number, too_deep, too_much };
  struct Limits {
    std::size_t depth = 0;   ///< containers around a value
    std::size_t pieces = 0;  ///< values, keys, begins and ends of containers, since the last value that was not kept
  };
  /// Asked for each complete value with at most two containers around it: keep it? `member`: of the document.
  using Keep = std::function<bool(std::size_t depth, const std::string& member, nlohmann::json& value)>;

  explicit JsonBuilder(Limits limits, Keep keep = {}) : limits_(limits), keep_(std::move(keep)) {}

  /// The document; whole if sax_parse() returned true.
  [[nodiscard]] nlohmann::json& document() { return document_; }
  /// Why sax_parse() returned false: no JSON at byte(), a number that does not fit, or a limit.
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
  std::vector<nlohmann::json*> open_;  ///< containers, the outermost first
  std::string key_;                    ///< of the value that follows
  std::string member_;                 ///< the last key of the outermost object
  std::vector<std::string> keys_;      ///< of the open containers in theirs
  std::size_t pieces_ = 0;
  Problem problem_ = Problem::none;
  std::size_t byte_ = 0;
};

}  // namespace terrella
