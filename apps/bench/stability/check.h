#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/gl/shader_functions.h"

namespace terrella::bench {

/// One figure of the self-test. What is not held to a limit is told all the same.
struct Check {
  std::string test;                                      ///< "jitter"
  std::string subject = {};                              ///< "tilted"
  double at = std::numeric_limits<double>::quiet_NaN();  ///< 10, of an eye so high; NaN: nowhere in particular
  std::string at_unit = {};
  double error = 0.0;
  std::string unit = {};
  double limit = std::numeric_limits<double>::quiet_NaN();  ///< the error must be at most this; NaN: no limit
  double ms = 0.0;                                          ///< that measuring it took
  [[nodiscard]] bool passed() const { return !(error > limit) && error == error; }
};
using Checks = std::vector<Check>;

/// What the checks have in common.
struct StabilityOptions {
  ShaderFunctions functions = ShaderFunctions::driver;  ///< that the shaders use
  bool quick = false;
};

/// Fills in the time. `measure` returns the error.
[[nodiscard]] inline Check timed(Check check, const std::function<double()>& measure) {
  const auto start = std::chrono::steady_clock::now();
  check.error = measure();
  check.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return check;
}

/// Each appends its figures; an error is a program that cannot be built. They need a current context, but for the
/// geodetic ones, and leave its state changed. thread: main
Status check_functions(const StabilityOptions& options, Checks& checks);
Status check_depth(const StabilityOptions& options, Checks& checks);
Status check_jitter(const StabilityOptions& options, Checks& checks);
Status check_places(const StabilityOptions& options, Checks& checks);
Status check_geodesy(const StabilityOptions& options, Checks& checks);
Status check_same_pixels(const StabilityOptions& options, Checks& checks);

}  // namespace terrella::bench
