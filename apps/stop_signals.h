#pragma once

#include <csignal>

namespace terrella {

/// While it lives, the first SIGINT or SIGTERM is noted rather than obeyed; the second one ends the program as ever.
/// One at a time. thread: main
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] static bool came();  ///< thread: any

 private:
  struct sigaction interrupt_before_ {};
  struct sigaction terminate_before_ {};
};

}  // namespace terrella
