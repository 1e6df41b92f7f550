#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "geo/objects.h"

namespace terrella {

/// How the objects of a feature look.
struct ObjectStyle {
  PointObject point;      ///< all but its place
  LineObject line;        ///< all but its places
  PolygonObject polygon;  ///< all but its rings
  LabelObject label;      ///< its text, empty for none, and priority
  std::string model;      ///< the file of a point's model; empty: none
  MeshObject mesh;        ///< all but its place; without a model the point is drawn
};

/// Told of each property that is wrong.
using Complain = std::function<void(const std::string& what)>;

/// Reads a feature's properties; those that lack or are wrong are as simplestyle 1.1.0 has them by default. thread: any
[[nodiscard]] ObjectStyle read_object_style(const nlohmann::json& properties, const Complain& complain);

/// "#rgb" or "#rrggbb", the number sign may lack.
[[nodiscard]] std::optional<ObjectColor> read_color(std::string_view text);

}  // namespace terrella
