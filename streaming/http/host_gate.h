#pragma once

#include <chrono>
#include <optional>

namespace terrella::http {

struct HostLimits {
  int connections = 6;      ///< most requests in flight while the host does not multiplex, ≥ 1
  int in_flight = 32;       ///< most requests in flight in any case, ≥ 1
  double rate_per_s = 0.0;  ///< rate of the token bucket; 0: no limit
  double burst = 32.0;      ///< size of the bucket, requests, ≥ 1
};

/// Decides when a host may be asked. Takes into account requests in flight, a token bucket, and pauses that the host
/// asked for. After a pause, half as many requests may be in flight as before. The number grows by one with each round
/// of good answers. Pure: the clock is an argument.
class HostGate {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = Time::duration;

  HostGate(const HostLimits& limits, Time now);

  [[nodiscard]] bool is_open(Time now) const { return opens_at(now) <= now; }
  /// Time at which one more request may be sent if no answer arrives before. Time::max() if only an answer can open the
  /// gate.
  [[nodiscard]] Time opens_at(Time now) const;
  void sent(Time now);
  void answered(bool well);          ///< one request fewer in flight; `well`: neither failed nor told to wait
  void learn(bool multiplexes);      ///< HTTP/2 or later: the number of connections is no limit
  void pause(Time until, Time now);  ///< sends nothing before `until`; never shortens a pause
  /// Gives the host up until then: requests to it fail at once.
  void give_up(Time until);
  [[nodiscard]] bool is_given_up(Time now) const { return given_up_until_ && now < *given_up_until_; }
  /// True if nothing is in flight, the bucket is full and there is no pause, as in a new gate.
  [[nodiscard]] bool is_idle(Time now) const;
  [[nodiscard]] int in_flight() const { return in_flight_; }
  [[nodiscard]] bool multiplexes() const { return multiplexes_; }
  [[nodiscard]] bool is_known() const { return known_; }  ///< true after learn()

 private:
  [[nodiscard]] int bound() const;
  [[nodiscard]] double tokens(Time now) const;

  HostLimits limits_;
  Time refilled_at_;
  double tokens_;
  double window_;
  Time not_before_ = Time::min();
  std::optional<Time> given_up_until_;
  int in_flight_ = 0;
  bool multiplexes_ = false;
  bool known_ = false;
};

}  // namespace terrella::http
