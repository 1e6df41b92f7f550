#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/gl/shader_functions.h"

namespace terrella::bench {

/// One figure of the self-test. Figures without a limit are reported too.
struct Check {
  std::string test;                                      ///< "jitter"
  std::string subject = {};                              ///< "tilted"
  double at = std::numeric_limits<double>::quiet_NaN();  ///< 10 for an eye at that height; NaN: no particular place
  std::string at_unit = {};
  double error = 0.0;
  std::string unit = {};
  double limit = std::numeric_limits<double>::quiet_NaN();  ///< greatest allowed error; NaN: no limit
  double ms = 0.0;                                          ///< time of the measurement
  [[nodiscard]] bool passed() const { return !(error > limit) && error == error; }
};
using Checks = std::vector<Check>;

/// Options shared by the checks.
struct StabilityOptions {
  ShaderFunctions functions = ShaderFunctions::driver;  ///< trigonometric functions of the shaders
  bool quick = false;
};

/// Adds the time to a check. `measure` returns the error.
[[nodiscard]] inline Check timed(Check check, const std::function<double()>& measure) {
  const auto start = std::chrono::steady_clock::now();
  check.error = measure();
  check.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return check;
}

/// Each function appends its figures. An error means that a shader program failed to build. All but the geodetic checks
/// need a current context and change its state. thread: main
Status check_functions(const StabilityOptions& options, Checks& checks);
Status check_depth(const StabilityOptions& options, Checks& checks);
Status check_jitter(const StabilityOptions& options, Checks& checks);
Status check_places(const StabilityOptions& options, Checks& checks);
Status check_geodesy(const StabilityOptions& options, Checks& checks);
Status check_same_pixels(const StabilityOptions& options, Checks& checks);

}  // namespace terrella::bench
