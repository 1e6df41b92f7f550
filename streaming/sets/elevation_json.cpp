#include "streaming/sets/elevation_json.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

namespace terrella {

std::optional<NumberInfo> rgb_encoding(const std::string& name) {
  NumberInfo info{.unit = "m", .quantity = "height"};
  info.rgb = true;
  if (name == "terrarium") {
    info.scale = 1.0 / 256.0;
    info.offset = -32768.0;
    return info;
  }
  if (name != "terrain-rgb" && name != "mapbox") return {};
  info.scale = 0.1;
  info.offset = -10000.0;
  return info;
}

std::optional<NumberInfo> read_elevation(const nlohmann::json& object, JsonFields& fields, const std::string& where) {
  if (fields.has("encoding")) {
    auto encoded = rgb_encoding(fields.text("encoding"));
    if (!encoded) fields.fail<int>("encoding", "must be \"terrain-rgb\" (or \"mapbox\") or \"terrarium\"");
    if (fields.has("elevation")) fields.fail<int>("encoding", "stands in place of \"elevation\"; leave one out");
    return encoded;
  }
  if (!fields.has("elevation")) return {};
  const nlohmann::json& value = object["elevation"];
  if (!value.is_object()) return fields.fail<std::optional<NumberInfo>>("elevation", "must be an object");
  JsonFields inner(value, where);
  NumberInfo info{.scale = inner.number("scale"),
                  .offset = inner.number("offset"),
                  .nodata = {},
                  .unit = inner.text("unit"),
                  .quantity = inner.text("quantity")};
  constexpr std::array kNumbers = {"unsigned", "signed", "float", "rgb"};
  const int numbers = inner.choice("numbers", kNumbers, 0);
  info.is_signed = numbers == 1;
  info.floats = numbers == 2;
  info.rgb = numbers == 3;
  if (info.rgb && inner.has("nodata")) inner.fail<int>("nodata", "is for other numbers; clear pixels have no data");
  if (!info.floats && !info.rgb) info.whole = info.is_signed ? WholeRange{-32768, 32767} : WholeRange{0, 65535};
  if (inner.has("nodata")) info.nodata = info.floats ? inner.number("nodata") : inner.integer("nodata", 0);
  if (inner.error())
    return fields.fail<std::optional<NumberInfo>>(
        "elevation",
        "takes the numbers scale, offset, nodata, the texts unit, quantity, and as \"numbers\": unsigned, signed, "
        "float or rgb");
  if (info.scale == 0.0) return fields.fail<std::optional<NumberInfo>>("elevation", "has a scale of 0");
  const double least = info.is_signed ? -32768.0 : 0.0;
  const double nodata = info.nodata.value_or(least);
  if (!info.floats && !info.rgb && (nodata < least || nodata > least + 65535.0)) {
    fields.fail<int>("elevation", fmt::format("has a nodata beyond {} to {}", least, least + 65535.0));
  }
  return info;
}

}  // namespace terrella
