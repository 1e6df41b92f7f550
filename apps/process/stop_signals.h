#pragma once

#include <array>
#include <chrono>
#include <csignal>
#include <optional>
#include <string>

namespace terrella {

/// Records the first SIGINT, SIGTERM or SIGHUP during its lifetime. The second signal of a kind ends the program at
/// once. A SIGHUP ignored at the start, as under nohup, stays ignored. Only one instance may exist at a time. thread:
/// main
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] static bool came();  ///< thread: any

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

/// Limits how long the calls of this thread wait for servers while it exists: the opening of inputs, not their tiles.
/// thread: that which made it
class WaitLimit {
 public:
  explicit WaitLimit(double seconds);
  ~WaitLimit();
  WaitLimit(const WaitLimit&) = delete;
  WaitLimit& operator=(const WaitLimit&) = delete;

  /// True once the limit of this thread has passed; false without a limit.
  [[nodiscard]] static bool passed();
  /// "; --timeout gives the server longer" if the limit of this thread has passed.
  [[nodiscard]] static std::string advice();

 private:
  const std::optional<std::chrono::steady_clock::time_point> before_;
};

/// True while a call may go on waiting for a server: no signal came (StopSignals), and no WaitLimit has passed.
[[nodiscard]] bool may_wait();

}  // namespace terrella
