#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "geo/ellipsoid.h"

// thread: any, for all of this header
namespace terrella {

/// A planet or moon: a name for people and a figure.
struct Body {
  std::string name;
  Ellipsoid ellipsoid;
};

/// Presets: earth (WGS 84), moon, mars, sphere (Earth's mean radius), phobos, saturn … ; source of each figure in
/// body.cpp.
[[nodiscard]] std::span<const Body> body_presets();

/// Earth, WGS 84: a = 6378137 m, f = 1/298.257223563.
[[nodiscard]] const Body& earth();

/// Reads `--body`: a preset's name, or "A,F" (semi-major axis in metres, flattening). The error names the text.
[[nodiscard]] Result<Body> parse_body(std::string_view text);

}  // namespace terrella
