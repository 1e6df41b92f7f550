#include "streaming/sets/elevation_json.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

namespace terrella {

std::optional<NumberInfo> read_elevation(const nlohmann::json& object, JsonFields& fields, const std::string& where) {
  if (!fields.has("elevation")) return {};
  const nlohmann::json& value = object["elevation"];
  if (!value.is_object()) return fields.fail<std::optional<NumberInfo>>("elevation", "must be an object");
  JsonFields inner(value, where);
  NumberInfo info{.scale = inner.number("scale"),
                  .offset = inner.number("offset"),
                  .nodata = {},
                  .unit = inner.text("unit"),
                  .quantity = inner.text("quantity")};
  constexpr std::array kNumbers = {"unsigned", "signed", "float"};
  const int numbers = inner.choice("numbers", kNumbers, 0);
  info.is_signed = numbers == 1;
  info.floats = numbers == 2;
  if (!info.floats) info.whole = info.is_signed ? WholeRange{-32768, 32767} : WholeRange{0, 65535};
  if (inner.has("nodata")) info.nodata = info.floats ? inner.number("nodata") : inner.integer("nodata", 0);
  if (inner.error())
    return fields.fail<std::optional<NumberInfo>>(
        "elevation",
        "takes the numbers scale, offset, nodata, the texts unit, quantity, and as \"numbers\": unsigned, signed or "
        "float");
  if (info.scale == 0.0) return fields.fail<std::optional<NumberInfo>>("elevation", "has a scale of 0");
  const double least = info.is_signed ? -32768.0 : 0.0;
  const double nodata = info.nodata.value_or(least);
  if (!info.floats && (nodata < least || nodata > least + 65535.0)) {
    fields.fail<int>("elevation", fmt::format("has a nodata beyond {} to {}", least, least + 65535.0));
  }
  return info;
}

}  // namespace terrella
