#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "geo/objects.h"
#include "geo/shown_when.h"

namespace terrella {

/// Appearance of the objects of a feature, all without their heights.
struct ObjectStyle {
  std::optional<HeightMode> heights;  ///< none: the positions decide
  PointObject point;                  ///< all but its place
  LineObject line;                    ///< all but its places
  PolygonObject polygon;              ///< all but its rings
  LabelObject label;                  ///< text, empty for no label, colour, priority and look
  std::string icon;                   ///< file or data: URI of a marker's icon; empty: none
  std::optional<float> icon_size_px;  ///< none: the picture's own size
  std::string model;                  ///< file of a point's model; empty: none
  MeshObject mesh;                    ///< all but its place; without a model the point is drawn
  ShownWhen shown;                    ///< all but the feature's id
};

/// Called with a message for each fault.
using Complain = std::function<void(const std::string& what)>;

/// Reads a feature's properties. Missing and faulty properties have the defaults of simplestyle 1.1.0. thread: any
[[nodiscard]] ObjectStyle read_object_style(const nlohmann::json& properties, const Complain& complain);

/// Parses "#rgb" or "#rrggbb"; the number sign is optional.
[[nodiscard]] std::optional<ObjectColor> read_color(std::string_view text);
/// Writes a colour as "#rrggbb", without its alpha.
[[nodiscard]] std::string color_text(const ObjectColor& color);

}  // namespace terrella
