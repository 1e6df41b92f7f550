#include "apps/bench/stability/check.h"

namespace terrella::bench {
namespace {

void add_functions(const std::string& test, const FunctionErrors& errors, double ms, double limit, Checks& checks) {
  const auto add = [&](const char* subject, double error, const char* unit, double most) {
    checks.push_back({.test = test, .subject = subject, .error = error, .unit = unit, .limit = most, .ms = ms});
  };
  add("atan, any quadrant", errors.atan, "relative", limit);
  add("asin (in no shader)", errors.asin, "rad", std::numeric_limits<double>::quiet_NaN());
  add("sin, half a turn either way", errors.sine, "absolute", limit);
  add("cos, half a turn either way", errors.cosine, "absolute", limit);
  add("inversesqrt, 1e-12 to 4", errors.inversesqrt, "relative", limit);
  add("length, 1e-7 to 2", errors.length, "relative", limit);
}

}  // namespace

// Reports both sets of functions; only the set used by the shaders has limits.
Status check_functions(const StabilityOptions& options, Checks& checks) {
  for (const ShaderFunctions functions : {ShaderFunctions::driver, ShaderFunctions::own}) {
    const auto start = std::chrono::steady_clock::now();
    const Result<FunctionErrors> errors = measure_shader_functions(functions);
    if (!errors) return errors.error();
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const bool used = functions == options.functions;
    const std::string whose = functions == ShaderFunctions::driver ? "driver's functions" : "own functions";
    add_functions(whose, *errors, ms, used ? kMostFunctionError : std::numeric_limits<double>::quiet_NaN(), checks);
  }
  return Done{};
}

}  // namespace terrella::bench
