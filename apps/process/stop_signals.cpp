#include "apps/process/stop_signals.h"

#include <utility>

namespace terrella {
namespace {

volatile std::sig_atomic_t g_came = 0;

using Clock = std::chrono::steady_clock;
thread_local std::optional<Clock::time_point> wait_until;

}  // namespace

StopSignals::StopSignals() {
  g_came = 0;
  struct sigaction action {};
  action.sa_handler = [](int) { g_came = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    const bool nohup = kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN;
    if (!nohup) sigaction(kSignals[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignals::came() { return g_came != 0; }

WaitLimit::WaitLimit(double seconds)
    : before_(std::exchange(wait_until, Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                           std::chrono::duration<double>(seconds)))) {}

WaitLimit::~WaitLimit() { wait_until = before_; }

bool WaitLimit::passed() { return wait_until && Clock::now() >= *wait_until; }

std::string WaitLimit::advice() { return passed() ? "; --timeout gives the server longer" : ""; }

bool may_wait() { return !StopSignals::came() && !WaitLimit::passed(); }

}  // namespace terrella
