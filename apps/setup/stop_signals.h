#pragma once

#include <array>
#include <csignal>

namespace terrella {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP is noted rather than obeyed; the second one of a kind ends the
/// program at once. A SIGHUP that was ignored at the start, as under nohup, stays ignored. One at a time. thread: main
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
