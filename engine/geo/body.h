#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

/// A planet or moon: its name, as shown to people, and its figure. The functions of this header are pure. thread: any
struct Body {
  std::string name;
  Ellipsoid ellipsoid;
};

/// All presets: earth (WGS 84), moon, mars, sphere (Earth's mean radius), phobos, saturn and more. Figures are
/// those of WGS 84 and of the report of the IAU of 2015.
[[nodiscard]] std::span<const Body> body_presets();

/// Earth, WGS 84: a = 6378137 m, f = 1/298.257223563.
[[nodiscard]] const Body& earth();

/// Reads the value of `--body`: the name of a preset, or "A,F" (semi-major axis in metres, flattening). The error
/// quotes the text.
[[nodiscard]] Result<Body> parse_body(std::string_view text);

}  // namespace terrella
