#include "streaming/json_text.h"

#include <fmt/format.h>

#include <utility>

namespace terrella {
namespace {

using nlohmann::json;

template <class Text>
Result<json> parse(Text& text, const JsonBuilder::Limits& limits, JsonBuilder::Keep keep) {
  JsonBuilder builder(limits, std::move(keep));
  json::sax_parse(text, &builder);
  switch (builder.problem()) {
    case JsonBuilder::Problem::syntax:
      return Error{fmt::format("not JSON at byte {}", builder.byte())};
    case JsonBuilder::Problem::number:
      return Error{fmt::format("the number at byte {} is too large; the largest is 1.8e308", builder.byte())};
    case JsonBuilder::Problem::too_deep:
      return Error{fmt::format("its lists and objects are nested more than {} deep", limits.depth)};
    case JsonBuilder::Problem::too_much:
      return Error{fmt::format("it has more than {} values and keys; divide it", limits.pieces)};
    case JsonBuilder::Problem::none:
      break;
  }
  return std::move(builder.document());
}

}  // namespace

Result<json> parse_json(std::string_view text, JsonBuilder::Limits limits) { return parse(text, limits, {}); }

Result<json> parse_json(std::istream& text, JsonBuilder::Limits limits, JsonBuilder::Keep keep) {
  return parse(text, limits, std::move(keep));
}

}  // namespace terrella
