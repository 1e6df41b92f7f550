#include "apps/viewer/timeline/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

#include "apps/viewer/input.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kTimelineWidth = 34.0F;  // in text heights
constexpr std::array kStepSpeeds = {0.5, 1.0, 2.0, 4.0, 8.0, 16.0};
constexpr std::array kStepSpeedNames = {"0.5 a second", "1 a second", "2 a second",
                                        "4 a second",   "8 a second", "16 a second"};
constexpr std::array kDirections = {"forwards", "backwards"};
constexpr std::array kZones = {"UTC", "local time"};
constexpr double kLongestStep_s = 1.0;

JoinedSteps joined(const std::vector<TimedLayer>& layers) {
  std::vector<std::shared_ptr<const TimeSteps>> steps;
  steps.reserve(layers.size());
  for (const TimedLayer& layer : layers) steps.push_back(layer.steps);
  return JoinedSteps(std::move(steps));
}

/// The layers whose dates the panel chooses.
std::vector<TimedLayer> led(std::vector<TimedLayer> layers) {
  std::erase_if(layers, &TimedLayer::follows);
  return layers;
}

std::vector<LayerId> ids_of(const std::vector<TimedLayer>& layers) {
  std::vector<LayerId> ids;
  ids.reserve(layers.size());
  for (const TimedLayer& layer : layers) ids.push_back(layer.id);
  return ids;
}

}  // namespace

std::vector<std::string> Timeline::shown() const {
  const std::vector<TimedLayer> layers = layers_();
  std::vector<std::string> texts;
  for (const TimedLayer& layer : layers) {
    const auto time = context_.globe.layer_time(layer.id);
    if (!time || !time->shown) continue;
    std::string text = step_text(*time->shown, local_);
    if (time->next) text += fmt::format(", {:.0f} % {}", 100.0 * time->next_share, step_text(*time->next, local_));
    texts.push_back(layers.size() == 1 ? text : layer.name + " " + text);
  }
  return texts;
}

UtcTime Timeline::now(const std::vector<TimedLayer>& layers) const {
  if (asked_ && ids_of(layers) == asked_of_) return *asked_;
  const auto time = context_.globe.layer_time(layers.front().id);
  return time && time->shown ? *time->shown : layers.front().steps->last();
}

bool Timeline::is_coming() const {
  return std::ranges::any_of(led(layers_()), [this](const TimedLayer& layer) {
    const auto time = context_.globe.layer_time(layer.id);
    return time && time->coming;
  });
}

void Timeline::go(UtcTime time) {
  const std::vector<TimedLayer> layers = led(layers_());
  stepped_ = Input::now();
  for (const TimedLayer& layer : layers) {
    if (!layer.steps->at_or_before(time)) continue;  // a layer that begins later stays as it is
    if (const Status set = context_.globe.set_layer_time(layer.id, time); !set) {
      play(false);
      return say(set.error());
    }
  }
  asked_ = time;
  asked_of_ = ids_of(layers);
}

void Timeline::step(bool backwards) {
  const std::vector<TimedLayer> layers = led(layers_());
  if (layers.empty()) return;
  play(false);
  if (const auto next = next_step(joined(layers), now(layers), {.backwards = backwards, .loops = play_.loops}))
    go(*next);
}

void Timeline::play(bool on) {
  playing_ = on;
  stepped_ = Input::now();
  if (on) return;
  for (const TimedLayer& layer : led(layers_()))
    static_cast<void>(context_.globe.load_layer_time(layer.id, std::nullopt));
}

void Timeline::advance() {
  if (!playing_ || is_coming()) return;
  const std::vector<TimedLayer> layers = led(layers_());
  const auto next = layers.empty() ? std::nullopt : next_step(joined(layers), now(layers), play_);
  if (seconds_left(kLongestStep_s) <= 0.0) return next ? go(*next) : play(false);
  if (!next) return;
  // A failure is told when the instant is asked for.
  for (const TimedLayer& layer : layers) static_cast<void>(context_.globe.load_layer_time(layer.id, next));
}

bool Timeline::changed() const { return playing_ && seconds_left(kLongestStep_s) <= 0.0 && !is_coming(); }

double Timeline::seconds_left(double most_s) const {
  if (!playing_ || is_coming()) return most_s;  // tiles that come wake the window
  const double step_s = 1.0 / kStepSpeeds[static_cast<std::size_t>(speed_)];
  return std::clamp(step_s - (Input::now() - stepped_).count(), 0.0, most_s);
}

bool Timeline::can_open() {
  if (!layers_().empty()) return true;
  say("No layer shown has dates. Layers of WMTS, WMS and URL templates with {time} may have some.");
  return false;
}

void Timeline::draw_open(float foot) {
  begin_left_panel(panel(), kTimelineWidth, foot, take_just_opened());
  const std::vector<TimedLayer> layers = layers_();
  layers.empty() ? write_wrapped("No layer shown has dates.") : draw_contents(layers);
  ImGui::End();
}

void Timeline::draw_contents(const std::vector<TimedLayer>& layers) {
  draw_dates(layers);
  const std::vector<TimedLayer> chosen = led(layers);
  if (chosen.empty())
    return write_wrapped("The dates follow the globe's time. T plays it; L gives a layer its own dates.", true);
  const JoinedSteps steps = joined(chosen);
  draw_slider(steps);
  draw_buttons(steps);
  draw_choices();
}

// A date is asked for when the slider is let go: each date passed would be requests.
void Timeline::draw_slider(const JoinedSteps& steps) {
  const UtcTime from = steps.first(), to = steps.last();
  const auto step_at = [&](double share) {
    return steps.at_or_before(from + std::chrono::duration_cast<UtcTime::duration>((to - from) * share)).value_or(from);
  };
  const UtcTime at = dragged_ ? step_at(*dragged_) : now(led(layers_()));
  double share = from == to ? 1.0 : double((at - from).count()) / double((to - from).count());
  if (dragged_) share = *dragged_;
  constexpr double kStart = 0.0, kEnd = 1.0;
  ImGui::SetNextItemWidth(-1.0F);
  const std::string text = step_text(at, local_);
  if (ImGui::SliderScalar("##date", ImGuiDataType_Double, &share, &kStart, &kEnd, text.c_str(),
                          ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput)) {
    dragged_ = share;
    if (playing_) play(false);
  }
  if (ImGui::IsItemDeactivated() && dragged_) go(step_at(*std::exchange(dragged_, std::nullopt)));
  tip(fmt::format("{} to {}", step_text(from, local_), step_text(to, local_)));
}

void Timeline::draw_buttons(const JoinedSteps& steps) {
  const auto button = [](const char* text, const char* what) {
    const bool pressed = ImGui::Button(text) || entered();
    tip(what);
    return pressed;
  };
  if (button("First", "The earliest date.")) play(false), go(steps.first());
  beside_if_room("Back");
  if (button("Back", "The date before.")) step(true);
  beside_if_room("Pause");
  if (button(playing_ ? "Pause##play" : "Play##play", "Shows date after date. A date appears when all of it is there."))
    play(!playing_);
  beside_if_room("Next");
  if (button("Next", "The date after.")) step(false);
  beside_if_room("Last");
  if (button("Last", "The latest date.")) play(false), go(steps.last());
}

void Timeline::draw_choices() {
  ImGui::Combo("Speed", &speed_, kStepSpeedNames.data(), static_cast<int>(kStepSpeedNames.size()));
  tip("Dates a second. A slow server slows the play down: no date is left out.");
  choose("Direction", play_.backwards, kDirections);
  choose("Clock", local_, kZones);
  tip("Zone of the times. Days have none.");
  ImGui::Checkbox("Loop", &play_.loops);
  tip("Begins again at the end.");
}

// One line for each layer, so that the panel keeps its height.
void Timeline::draw_dates(const std::vector<TimedLayer>& layers) const {
  for (const TimedLayer& layer : layers) {
    const auto time = context_.globe.layer_time(layer.id);
    if (!time) continue;
    if (!time->shown) {
      write_wrapped(fmt::format("{}: no date before {}", layer.name, step_text(layer.steps->first(), local_)));
      continue;
    }
    const UtcTime asked = layer.follows ? *context_.globe.options().time : now(led(layers));
    const auto wanted = layer.steps->at_or_before(asked);
    std::string text = fmt::format("{}: {}", layer.name, step_text(*time->shown, local_));
    if (time->coming) {
      text += fmt::format(", {} is loading", step_text(*time->coming, local_));
    } else if (wanted && *wanted != *time->shown) {
      text += fmt::format(", {} is missing", step_text(*wanted, local_));
    }
    write_wrapped(text);
  }
}

}  // namespace terrella
