#include "apps/viewer/parts/messages.h"

#include <algorithm>
#include <utility>

#include "apps/process/option_names.h"

namespace terrella {
namespace {

constexpr std::chrono::seconds kMessageTime(4);
constexpr int kMostLines = 6;                            // lines of faults
constexpr std::chrono::milliseconds kCharacterTime(50);  // reading time per character

}  // namespace

void Messages::say(const std::string& text) {
  const auto time = kMessageTime + kCharacterTime * text.size();
  say(text, time);
}

void Messages::say(const std::string& text, Clock::duration time) {
  text_ = shown_message(text);
  until_ = Clock::now() + time;
}

void Messages::say_then(const std::string& text, std::function<void()> act) {
  say(text);
  act_ = std::move(act);
}

void Messages::say(const Error& fault) {
  fault_ = shown_message(fault.message);
  text_.clear();
}

void Messages::report(const std::string& problem) {
  const std::string shown = shown_message(problem);
  if (fault_.find(shown) != fault_.npos) return;
  if (std::ranges::count(fault_, '\n') >= kMostLines) fault_.erase(0, fault_.find('\n') + 1);
  fault_ += fault_.empty() ? shown : "\n" + shown;
}

std::string Messages::text() const { return fault_ + (fault_.empty() || text_.empty() ? "" : "\n") + text_; }

bool Messages::close_fault() { return !std::exchange(fault_, {}).empty(); }

void Messages::begin_frame() {
  if (is_due()) text_.clear();
  act_shown_ = has_waiting();
}

void Messages::end_frame() {
  if (std::exchange(act_shown_, false)) std::exchange(act_, nullptr)();
}

double Messages::seconds_left(double most_s) const {
  if (text_.empty()) return most_s;
  return std::clamp(std::chrono::duration<double>(until_ - Clock::now()).count(), 0.001, most_s);
}

}  // namespace terrella
