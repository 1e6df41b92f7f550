#include "streaming/sets/elevation_json.h"

#include <nlohmann/json.hpp>

namespace terrella {

std::optional<ElevationInfo> read_elevation(const nlohmann::json& object, JsonFields& fields,
                                            const std::string& where) {
  if (!fields.has("elevation")) return {};
  const nlohmann::json& value = object["elevation"];
  if (!value.is_object()) return fields.fail<std::optional<ElevationInfo>>("elevation", "must be an object");
  JsonFields inner(value, where);
  ElevationInfo info{.scale = inner.number("scale"), .offset = inner.number("offset"), .nodata = {}};
  if (inner.has("nodata")) info.nodata = inner.integer("nodata", 0);
  if (inner.error())
    return fields.fail<std::optional<ElevationInfo>>("elevation", "takes the numbers scale, offset, nodata");
  if (info.scale == 0.0) return fields.fail<std::optional<ElevationInfo>>("elevation", "has a scale of 0");
  const double nodata = info.nodata.value_or(0.0);
  if (nodata < 0.0 || nodata > 65535.0) fields.fail<int>("elevation", "has a nodata beyond 0 to 65535");
  return info;
}

}  // namespace terrella
