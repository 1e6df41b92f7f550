#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/bench/report/report.h"
#include "base/result.h"
#include "render/gl/shader_functions.h"

namespace terrella::bench {

enum class Effort {
  quick,   ///< seconds, small pictures: a trial run; do not quote its figures
  normal,  ///< minutes on two cores of a software rasteriser
  full,    ///< the whole grid
};

struct BenchOptions {
  Effort effort = Effort::normal;
  std::filesystem::path work;  ///< keeps the planet, its tiles and the ground truth between runs
  std::string only = {};       ///< runs only views or flights whose name contains this text; empty: all
  std::optional<ShaderFunctions> functions = {};  ///< functions of the self-test's shaders; none: the engine chooses
  std::vector<std::string> commands = {};         ///< shell commands of bench_programs(), which takes turns with them
  std::string reset = {};                         ///< shell command before each of these, not measured; empty: none
  int rounds = 5;                                 ///< rounds of bench_programs(), at least 1
  std::function<void(const std::string& doing)> progress = [](const std::string&) {};
  std::function<bool()> goes_on = [] { return true; };  ///< called while pictures are cut; false stops

  [[nodiscard]] bool wants(std::string_view name) const { return name.find(only) != std::string_view::npos; }
};

/// Runs a benchmark and returns its table. An error names the missing part. Each benchmark creates its own OpenGL
/// context and needs the processor for itself. thread: main
[[nodiscard]] Result<Report> bench_views(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_polar(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_accuracy(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_traverse(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_stream(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_objects(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_layers(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_stability(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_growth(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_features(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_limb(const BenchOptions& options);
[[nodiscard]] Result<Report> bench_programs(const BenchOptions& options);

}  // namespace terrella::bench
