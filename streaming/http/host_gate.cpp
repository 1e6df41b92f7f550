#include "streaming/http/host_gate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace terrella::http {
namespace {

using Seconds = std::chrono::duration<double>;

// A rounding error could end the wait for a token too early, and the thread would wake twice.
constexpr double kWhole = 1.0 - 1e-9;

}  // namespace

HostGate::HostGate(const HostLimits& limits, Time now)
    : limits_(limits), refilled_at_(now), tokens_(limits.burst), window_(limits.in_flight) {
  assert(limits.connections >= 1 && limits.in_flight >= 1);
  assert(limits.rate_per_s >= 0.0 && limits.burst >= 1.0);
}

int HostGate::bound() const {
  const int window = std::max(1, static_cast<int>(window_));
  return multiplexes_ ? window : std::min(window, limits_.connections);
}

double HostGate::tokens(Time now) const {
  const double earned = std::max(0.0, Seconds(now - refilled_at_).count()) * limits_.rate_per_s;
  return std::min(limits_.burst, tokens_ + earned);
}

HostGate::Time HostGate::opens_at(Time now) const {
  if (in_flight_ >= bound()) return Time::max();
  Time opens = std::max(now, not_before_);
  if (limits_.rate_per_s <= 0.0) return opens;
  const double missing = kWhole - tokens(now);
  if (missing <= 0.0) return opens;
  const auto wait = std::chrono::duration_cast<Duration>(Seconds(missing / limits_.rate_per_s)) + Duration(1);
  return std::max(opens, now + wait);
}

void HostGate::sent(Time now) {
  assert(is_open(now));
  tokens_ = tokens(now) - 1.0;
  refilled_at_ = now;
  ++in_flight_;
}

void HostGate::answered(bool well) {
  assert(in_flight_ > 0);
  --in_flight_;
  if (well) window_ = std::min<double>(limits_.in_flight, window_ + 1.0 / window_);
}

void HostGate::learn(bool multiplexes) {
  multiplexes_ = multiplexes;
  known_ = true;
}

void HostGate::pause(Time until, Time now) {
  // Several answers to one burst may ask for a pause. They count as one reason to reduce the number in flight.
  if (now >= not_before_) window_ = std::max(1.0, std::floor(bound() / 2.0));
  not_before_ = std::max(not_before_, until);
}

void HostGate::give_up(Time until) {
  given_up_until_ = std::max(until, given_up_until_.value_or(until));
  not_before_ = std::max(not_before_, until);
}

bool HostGate::is_idle(Time now) const {
  return in_flight_ == 0 && now >= not_before_ && (limits_.rate_per_s <= 0.0 || tokens(now) >= limits_.burst);
}

}  // namespace terrella::http
