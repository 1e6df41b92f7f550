#include "apps/viewer/parts/view_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <tuple>
#include <utility>

#include "apps/viewer/input.h"

namespace terrella {
namespace {

constexpr std::chrono::seconds kResetTime(4);  // for the second reset

}  // namespace

ViewModes::ViewModes(const ViewerContext& context, std::span<const Action> actions,
                     std::function<void(const Action&)> run)
    : Panel(context, "View"),
      actions_(actions),
      run_(std::move(run)),
      underground_(context),
      play_(context),
      sky_(context.globe.options().sky),
      start_(modes()) {}

ViewSettings ViewModes::modes() const {
  const GlobeOptions& options = context_.globe.options();
  ViewSettings modes;
  modes.surface = options.surface;
  modes.stereo = options.stereo;
  modes.under_ground = underground_.is_below();
  modes.has_sky = options.sky;
  modes.sky = sky_;
  modes.time = options.time;
  modes.has_lights = options.sky && options.body.name == earth().name && !options.night_lights.values.empty();
  modes.night_lights = context_.globe.has_night_lights();
  modes.playing = play_.is_playing();
  modes.speed = play_.speed();
  modes.has_relief = context_.globe.has_relief();
  modes.exaggeration = options.exaggeration;
  modes.units = context_.ui.units();
  return modes;
}

// Setting a value draws a frame, so unchanged values are not set.
void ViewModes::apply(const ViewSettings& settings) {
  Globe& globe = context_.globe;
  const GlobeOptions& options = globe.options();
  if (settings.surface != options.surface) globe.set_surface(settings.surface);
  if (settings.stereo != options.stereo) globe.set_stereo(settings.stereo);
  if (settings.sky != sky_) globe.set_sky(sky_ = settings.sky);
  if (settings.exaggeration != options.exaggeration) globe.set_exaggeration(settings.exaggeration);
  context_.ui.use_units(settings.units);
  play_.set_speed(settings.speed);
  if (settings.playing != play_.is_playing()) play_.play(settings.playing);
  if (settings.night_lights != globe.has_night_lights()) {
    if (const Status lit = globe.set_night_lights(settings.night_lights); !lit) say(lit.error());
  }
  if (settings.time == options.time) return;
  if (options.time || !settings.time) return set_time(settings.time);
  context_.messages.say_then(kTimeMessage, [this, time = settings.time] {
    say("Date and time are on");
    set_time(time);
  });
}

void ViewModes::set_time(std::optional<UtcTime> time) {
  const Status set = context_.globe.set_time(time);
  settings_.time_problem = set ? "" : set.error().message;
}

// Reads the globe's modes first, because keys may have changed them.
void ViewModes::draw_open(float foot) {
  ViewSettings now = modes();
  now.time_text = std::move(settings_.time_text);
  now.time_problem = std::move(settings_.time_problem);
  now.written = settings_.written;
  settings_ = std::move(now);
  const Action* clicked = draw_view_settings(panel(), settings_, actions_, foot, take_just_opened());
  apply(settings_);
  if (settings_.under_ground != underground_.is_below()) underground_.toggle();
  if (clicked != nullptr) run_(*clicked);
}

void ViewModes::next_opacity() {
  constexpr double kAlphas[] = {1.0, 0.7, 0.4};
  SurfaceLook surface = context_.globe.options().surface;
  const auto* lower =
      std::find_if(std::begin(kAlphas), std::end(kAlphas), [&](double alpha) { return alpha < surface.alpha - 0.01; });
  surface.alpha = lower == std::end(kAlphas) ? kAlphas[0] : *lower;
  context_.globe.set_surface(surface);
  say(fmt::format("Opacity {:.0f} %", 100.0 * surface.alpha));
}

void ViewModes::next_stereo() {
  struct Step {
    Stereo mode;
    const char* message;
  };
  constexpr std::array<Step, 4> kSteps{{{Stereo::off, "Stereo off"},
                                        {Stereo::anaglyph, "Stereo: anaglyph, red for the left eye"},
                                        {Stereo::side_by_side, "Stereo: side by side"},
                                        {Stereo::interlaced, "Stereo: interlaced, even rows for the left eye"}}};
  StereoLook stereo = context_.globe.options().stereo;
  const auto now = std::ranges::find(kSteps, stereo.mode, &Step::mode);
  const Step& next = kSteps[std::size_t(now - kSteps.begin() + 1) % kSteps.size()];
  stereo.mode = next.mode;
  context_.globe.set_stereo(stereo);
  say(next.message);
}

void ViewModes::toggle_sky() {
  context_.globe.set_sky(sky_ = !sky_);
  say(sky_ ? "Sky on" : "Sky off");
}

bool ViewModes::is_as_started() const {
  const ViewSettings now = modes();
  const auto values = [](const ViewSettings& s) {
    return std::tie(s.surface, s.stereo, s.under_ground, s.sky, s.time, s.night_lights, s.playing, s.exaggeration);
  };
  return values(now) == values(start_);
}

void ViewModes::reset() {
  const bool again = Input::now() < std::exchange(reset_until_, Seconds(-1.0));
  if (!again && !is_as_started()) {
    reset_until_ = Input::now() + kResetTime;
    return context_.messages.say("Reset again (R) to lose the time and all settings of the view", kResetTime);
  }
  ViewSettings start = start_;
  start.units = context_.ui.units();  // habits of the user, not modes
  start.speed = play_.speed();
  apply(start);
  underground_.return_above();
  context_.navigator.key(NavigationKey::whole_globe, Input::now());
  say("View reset");
}

}  // namespace terrella
