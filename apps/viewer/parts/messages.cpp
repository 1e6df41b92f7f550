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
  is_fault_ = false;
  until_ = Clock::now() + time;
}

void Messages::say_then(const std::string& text, std::function<void()> act) {
  say(text);
  act_ = std::move(act);
}

void Messages::say(const Error& fault) {
  say(fault.message);
  is_fault_ = true;
}

void Messages::report(const std::string& problem) {
  if (!is_fault_) return say(Error{problem});
  if (text_.find(shown_message(problem)) != text_.npos) return;
  const bool full = std::ranges::count(text_, '\n') >= kMostLines;
  say(Error{(full ? text_.substr(text_.find('\n') + 1) : text_) + "\n" + problem});
}

bool Messages::close_fault() {
  if (!is_fault_) return false;
  text_.clear();
  is_fault_ = false;
  return true;
}

void Messages::begin_frame() {
  if (is_due()) text_.clear();
  act_shown_ = has_waiting();
}

void Messages::end_frame() {
  if (std::exchange(act_shown_, false)) std::exchange(act_, nullptr)();
}

double Messages::seconds_left(double most_s) const {
  if (text_.empty() || is_fault_) return most_s;
  return std::clamp(std::chrono::duration<double>(until_ - Clock::now()).count(), 0.001, most_s);
}

}  // namespace terrella
