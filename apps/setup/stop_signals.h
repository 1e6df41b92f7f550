#pragma once

#include <array>
#include <csignal>

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

}  // namespace terrella
