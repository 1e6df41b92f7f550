#include "streaming/json_text.h"

#include <fmt/format.h>

#include <exception>

namespace terrella {
namespace {

using nlohmann::json;

struct TooDeep : std::exception {};

template <class Text>
Result<json> parse(Text& text, const json::parser_callback_t& visit) {
  try {
    return json::parse(text, [&visit](int depth, json::parse_event_t event, json& value) {
      if (depth > kMaxJsonDepth) throw TooDeep();
      return visit == nullptr || visit(depth, event, value);
    });
  } catch (const json::parse_error& error) {
    return Error{fmt::format("not JSON at byte {}", error.byte)};
  } catch (const json::out_of_range&) {
    return Error{"a number in it is too large; the largest is 1.8e308"};
  } catch (const TooDeep&) {
    return Error{fmt::format("its lists and objects are nested more than {} deep", kMaxJsonDepth)};
  }
}

}  // namespace

Result<json> parse_json(std::string_view text, const json::parser_callback_t& visit) { return parse(text, visit); }

Result<json> parse_json(std::istream& text, const json::parser_callback_t& visit) { return parse(text, visit); }

}  // namespace terrella
