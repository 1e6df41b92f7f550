#include "apps/viewer/panels/view_settings.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <utility>

#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/parts/time_play.h"

namespace terrella {
namespace {

constexpr float kWidth = 23.0F;  // in text heights
constexpr double kDeepest_km = 6000.0, kShallowest_km = 150.0;
constexpr std::array kSpeeds = {1.0, 60.0, 600.0, 3600.0, 86400.0};
constexpr std::array kSpeedNames = {"1x", "60x", "600x", "3600x", "86400x"};

void draw_surface(SurfaceLook& surface) {
  slide("Opacity", surface.alpha, 0.0, 1.0, "%.2f");
  tip("Opacity of the ground; U switches between 1, 0.7 and 0.4. Below 1 the ground is drawn twice, so that the front "
      "hides its own back.");
  choose("Blend", surface.blend, std::array{"normal", "additive"});
  tip("normal: objects below fade behind the ground. additive: objects below keep their brightness; bright places may "
      "saturate.");
  bool inner = surface.inner_sphere_below_m.has_value();
  if (ImGui::Checkbox("Inner sphere", &inner)) {
    surface.inner_sphere_below_m = inner ? std::optional<double>(1.0e6) : std::nullopt;
  }
  tip("Hides the far side of the globe. Without this sphere the whole inside is visible.");
  if (surface.inner_sphere_below_m) {
    double depth_km = *surface.inner_sphere_below_m / 1e3;
    slide("Depth", depth_km, kShallowest_km, kDeepest_km, "%.0f km");
    surface.inner_sphere_below_m = 1e3 * depth_km;
    tip("Depth of the inner sphere under the equator. The deepest earthquakes are at 700 km.");
  }
}

void draw_from_below(ViewSettings& settings) {
  ImGui::Checkbox("Go under the ground", &settings.under_ground);
  tip("X: moves the eye straight below the ground, looking up, and back.");
  choose("Ground from below", settings.surface.from_below, std::array{"opaque", "translucent", "selective"});
  tip("Look of the ground from below, if Opacity is under 1. selective: only objects with \"through_surface\" in "
      "GeoJSON show through.");
  choose("Horizon culling", settings.surface.horizon_culling, std::array{"auto", "on", "off"});
  tip("auto skips what the planet hides. on also skips the far half when the eye is under the ground, for views of a "
      "nearby object. off draws everything in the frame.");
}

void draw_light(ViewSettings& settings) {
  SurfaceLook& surface = settings.surface;
  if (settings.has_relief) {
    ImGui::Checkbox("Hillshade", &surface.hillshade);
    tip("Shades mountains by light from the north-west, as maps do, instead of by the Sun.");
  }
  choose("Magnified imagery", surface.sharpness, std::array{"auto", "bilinear", "bicubic"});
  tip("Filter where the imagery has no finer detail. bicubic shows no squares. auto: bicubic, in unlit views "
      "bilinear.");
  ImGui::ColorEdit3("Inner sphere's colour", &surface.inner_sphere_srgb.x, ImGuiColorEditFlags_NoInputs);
  tip("Colour of the inner sphere under a translucent ground. Black shows no sphere unless objects lie below.");
}

void set_time(ViewSettings& settings, std::optional<UtcTime> time) {
  settings.time = time;
  settings.written = time;
  settings.time_problem.clear();
  settings.time_text = time_field(time);
}

void draw_time_sliders(ViewSettings& settings) {
  using namespace std::chrono;
  const auto day = floor<days>(*settings.time);
  const sys_days new_year{year_month_day{day}.year() / January / 1};
  int of_year = static_cast<int>((day - new_year).count()) + 1;
  double hour = duration<double, std::ratio<3600>>(*settings.time - day).count();
  const double hour_before = hour;
  const int day_before = of_year;
  slide("Hour", hour, 0.0, 24.0, "%.1f h UTC");
  tip("Time of day in UTC; moves the night around the globe.");
  ImGui::SliderInt("Day of the year", &of_year, 1, 365, "%d", ImGuiSliderFlags_AlwaysClamp);
  tip("Date; moves the Sun between the tropics, the Moon and the stars.");
  if (hour == hour_before && of_year == day_before) return;
  set_time(settings, new_year + days{of_year - 1} + minutes{static_cast<int>(hour * 60.0)});
}

void draw_play(ViewSettings& settings) {
  if (ImGui::Button(settings.playing ? "Pause" : "Play")) settings.playing = !settings.playing;
  tip("T: plays or pauses the time.");
  ImGui::SameLine();
  auto speed = std::size_t(std::ranges::find(kSpeeds, settings.speed) - kSpeeds.begin()) % kSpeeds.size();
  ImGui::SetNextItemWidth(0.3F * kWidth * ImGui::GetFontSize());
  choose("Speed", speed, kSpeedNames);
  settings.speed = kSpeeds[speed];
  tip("At 60x a minute passes in a second, at 3600x an hour, at 86400x a day.");
}

void draw_night_lights(ViewSettings& settings) {
  if (!settings.has_lights) return;
  ImGui::Checkbox("Night lights", &settings.night_lights);
  tip("Lights of the cities on the night side.");
}

void draw_time(ViewSettings& settings) {
  if (settings.written != settings.time) set_time(settings, settings.time);
  std::array<char, 40> text{};
  settings.time_text.copy(text.data(), text.size() - 1);
  if (ImGui::InputTextWithHint("Time", "e.g. 2026-06-21T12:00Z", text.data(), text.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue)) {
    settings.time_text = text.data();
    const Result<UtcTime> time = parse_utc(settings.time_text);
    if (time && !settings.time) settings.night_lights = settings.has_lights;
    if (time) set_time(settings, *time);
    if (!time) settings.time_problem = time.error().message;
  }
  tip("UTC, 1950 to 2050, for example 2026-06-21T12:00Z; then press Enter. Without a time the light comes over the "
      "viewer's shoulder.");
  if (!settings.time_problem.empty()) write_wrapped(settings.time_problem);
  bool has_time = settings.time.has_value();
  if (ImGui::Checkbox("Use date and time", &has_time)) {
    set_time(settings, has_time ? std::optional<UtcTime>(present_time()) : std::nullopt);
    settings.night_lights = has_time && settings.has_lights;
  }
  tip("Places Sun, Moon and stars as they are at the time above. Begins with the present.");
  if (!settings.time) return;
  draw_time_sliders(settings);
  draw_play(settings);
  draw_night_lights(settings);
}

void draw_stereo(StereoLook& stereo) {
  choose("Stereo", stereo.mode, std::array{"off", "side by side", "interlaced", "anaglyph"});
  tip("S: next kind. anaglyph: red glass for the left eye, cyan for the right. interlaced: even rows for the left eye. "
      "side by "
      "side: the left eye's picture is on the left.");
  bool by_itself = !stereo.eye_separation_m.has_value();
  if (ImGui::Checkbox("Automatic eye separation", &by_itself)) {
    stereo.eye_separation_m = by_itself ? std::nullopt : std::optional<double>(1.0e5);
  }
  tip("1/30 of the distance to the picture's centre: comfortable from orbit to street level.");
  if (!stereo.eye_separation_m) return;
  double apart_km = *stereo.eye_separation_m / 1e3;
  slide("Eye separation", apart_km, 1.0e-4, 5.0e3, "%.4g km",
        ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
  stereo.eye_separation_m = 1e3 * apart_km;
  tip("Larger values deepen the scene; very large values strain the eyes.");
}

const Action* draw_buttons(std::span<const Action> actions) {
  const Action* clicked = nullptr;
  bool first = true;
  for (const Action& action : actions) {
    if (action.button == nullptr) continue;
    if (!std::exchange(first, false)) beside_if_room(action.button);
    if (ImGui::Button(action.button)) clicked = &action;
    tip(fmt::format("{}: {}", action.keys, action.what));
  }
  return clicked;
}

}  // namespace

std::string time_field(std::optional<UtcTime> time) {
  if (!time) return {};
  return fmt::format("{:%Y-%m-%dT%H:%MZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(*time)));
}

const Action* draw_view_settings(const char* title, ViewSettings& settings, std::span<const Action> actions, float foot,
                                 bool just_opened) {
  begin_left_panel(title, kWidth, foot, just_opened);
  ImGui::PushItemWidth(0.5F * kWidth * ImGui::GetFontSize());
  const Action* clicked = draw_buttons(actions);
  group("Surface");
  draw_surface(settings.surface);
  if (settings.has_relief) {
    slide("Exaggeration", settings.exaggeration, 0.0, 30.0, "%.1f times");
    tip("Factor for the ground's heights.");
  }
  if (settings.has_sky) {
    group("Sky and time");
    ImGui::Checkbox("Sky", &settings.sky);
    tip("B: stars, Sun, Moon and atmosphere.");
    if (settings.sky) draw_time(settings);
  }
  group("Under the ground");
  draw_from_below(settings);
  group("Stereo view");
  draw_stereo(settings.stereo);
  group("Light and detail");
  draw_light(settings);
  group("Texts");
  choose("Units", settings.units, std::array{"metric", "imperial", "nautical"});
  tip("Units of the scale bar, of heights and of measured lengths and areas. Kept for the next start.");
  ImGui::PopItemWidth();
  ImGui::End();
  return clicked;
}

}  // namespace terrella
