#include "apps/viewer/parts/messages.h"

#include <algorithm>
#include <utility>

namespace terrella {
namespace {

constexpr std::chrono::seconds kMessageTime(4);
constexpr std::chrono::milliseconds kCharacterTime(50);  // reading time per character

}  // namespace

void Messages::say(std::string text) {
  const auto time = kMessageTime + kCharacterTime * text.size();
  say(std::move(text), time);
}

void Messages::say(std::string text, Clock::duration time) {
  text_ = std::move(text);
  until_ = Clock::now() + time;
}

void Messages::report(const std::string& problem) {
  const bool more = !problems_.empty() && text_ == problems_;
  problems_ = more ? problems_ + "\n" + problem : problem;
  say(problems_);
}

void Messages::drop_due() {
  if (is_due()) text_.clear();
}

double Messages::seconds_left(double most_s) const {
  if (text_.empty()) return most_s;
  return std::clamp(std::chrono::duration<double>(until_ - Clock::now()).count(), 0.001, most_s);
}

}  // namespace terrella
