#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"

namespace terrella::bench {
namespace {

/// Costs of one command, a figure for each round.
struct CommandCosts {
  std::vector<double> wall_s, cpu_s, peak_mb;
};

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Starts a shell command whose output nobody sees; none if that fails.
std::optional<pid_t> start(const std::string& command) {
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  for (const int out : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&silent, out, "/dev/null", O_WRONLY, 0);
  }
  std::string shell = "sh", option = "-c", text = command;
  char* const words[] = {shell.data(), option.data(), text.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/bin/sh", &silent, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&silent);
  return failed == 0 ? std::optional(child) : std::nullopt;
}

/// Runs a shell command to its end and adds its costs, those of its own children included.
Status measure_command(const std::string& command, CommandCosts& costs) {
  const auto begin = std::chrono::steady_clock::now();
  const std::optional<pid_t> child = start(command);
  if (!child) return Error{fmt::format("cannot start a shell for '{}'", command)};
  int status = 0;
  rusage usage{};
  while (wait4(*child, &status, 0, &usage) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return Error{fmt::format("'{}' ended with {} {}; run it by itself to read its messages", command,
                             WIFEXITED(status) ? "exit code" : "signal",
                             WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status))};
  }
  costs.wall_s.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  costs.cpu_s.push_back(seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime));
  costs.peak_mb.push_back(static_cast<double>(usage.ru_maxrss) / 1024.0);
  return Done{};
}

Report programs_report(const BenchOptions& options, const std::vector<CommandCosts>& costs) {
  Report report{.name = "programs",
                .title = "Commands in turn: medians, and ratios to the first command",
                .facts = {{"rounds", std::to_string(costs.front().wall_s.size())},
                          {"ratios", "medians over the rounds of the command's cost by the first command's"}},
                .columns = {{"command", ""},
                            {"time", "s, median", 3},
                            {"least", "s", 3},
                            {"cpu", "s of processor, median", 3},
                            {"peak", "MiB of memory, most", 0},
                            {"time_ratio", "of the first"},
                            {"cpu_ratio", "of the first"},
                            {"peak_ratio", "of the first"}}};
  const CommandCosts& first = costs.front();
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const CommandCosts& c = costs[k];
    report.rows.push_back({options.commands[k], median(c.wall_s), std::ranges::min(c.wall_s), median(c.cpu_s),
                           std::ranges::max(c.peak_mb), median_ratio(c.wall_s, first.wall_s),
                           median_ratio(c.cpu_s, first.cpu_s), median_ratio(c.peak_mb, first.peak_mb)});
  }
  report.plots = {{.title = "time and memory", .x = "time", .y = "peak", .series = "command", .lines = false}};
  return report;
}

}  // namespace

Result<Report> bench_programs(const BenchOptions& options) {
  if (options.commands.empty()) return Error{"no COMMAND to measure"};
  std::vector<CommandCosts> costs(options.commands.size());
  for (int round = 1; round <= options.rounds; ++round) {
    for (std::size_t k = 0; k < costs.size(); ++k) {
      options.progress(fmt::format("round {} of {}: {}", round, options.rounds, options.commands[k]));
      CommandCosts unmeasured;
      if (!options.reset.empty()) {
        if (const Status reset = measure_command(options.reset, unmeasured); !reset) return reset.error();
      }
      if (const Status done = measure_command(options.commands[k], costs[k]); !done) return done.error();
    }
  }
  return programs_report(options, costs);
}

}  // namespace terrella::bench
