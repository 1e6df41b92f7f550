#include "apps/viewer/parts/time_play.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "apps/viewer/input.h"

namespace terrella {
namespace {

constexpr double kSkyStep_s = 4.0;  // the Sun moves by 1/60 of a degree, which nobody sees
constexpr double kFastest_s = 1.0 / 30.0, kSlowest_s = 1.0;

}  // namespace

UtcTime present_time() { return std::chrono::floor<std::chrono::minutes>(std::chrono::system_clock::now()); }

double TimePlay::step_s() const { return std::clamp(kSkyStep_s / speed_, kFastest_s, kSlowest_s); }

void TimePlay::play(bool on) {
  if (on && !context_.globe.options().time) return context_.messages.say_then(kTimeMessage, [this] { start(); });
  playing_ = on;
  stepped_ = Input::now();
  say(on ? fmt::format("Time runs at {:.0f}x", speed_) : "Time paused");
}

void TimePlay::start() {
  Status set = context_.globe.set_time(present_time());
  if (set) set = context_.globe.set_night_lights(true);
  set ? play(true) : say(set.error());
}

void TimePlay::advance(Seconds now) {
  if (!playing_ || (now - stepped_).count() < step_s()) return;
  const auto& time = context_.globe.options().time;
  if (!time) {
    playing_ = false;
    return;
  }
  const auto by = std::chrono::duration_cast<UtcTime::duration>((now - stepped_) * speed_);
  stepped_ = now;
  const Status set = context_.globe.set_time(*time + by);
  if (set) return;
  playing_ = false;
  say(set.error());
}

bool TimePlay::changed() const { return playing_ && seconds_left(kSlowest_s) <= 0.0; }

double TimePlay::seconds_left(double most_s) const {
  if (!playing_) return most_s;
  return std::clamp(step_s() - (Input::now() - stepped_).count(), 0.0, most_s);
}

}  // namespace terrella
