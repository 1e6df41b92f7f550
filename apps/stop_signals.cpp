#include "apps/stop_signals.h"

namespace terrella {
namespace {

volatile std::sig_atomic_t g_came = 0;

}  // namespace

StopSignals::StopSignals() {
  g_came = 0;
  struct sigaction action {};
  action.sa_handler = [](int) { g_came = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, &interrupt_before_);
  sigaction(SIGTERM, &action, &terminate_before_);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
}

bool StopSignals::came() { return g_came != 0; }

}  // namespace terrella
