#include "apps/viewer/view_settings.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <ctime>

namespace terrella {
namespace {

constexpr float kWidth = 23.0F;     // of the text's height
constexpr float kTipWidth = 26.0F;  // of the text's height
constexpr double kDeepest_km = 6000.0, kShallowest_km = 150.0;
constexpr UtcTime kFirstTime{std::chrono::sys_days{std::chrono::year{2026} / 6 / 21} + std::chrono::hours{12}};

/// Shown while the item before is under the cursor, or has the keyboard and a key has moved that on.
void tip(const char* text) {
  const bool chosen = ImGui::IsItemFocused() && ImGui::GetIO().NavVisible;
  if (!ImGui::IsItemHovered() && !chosen) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(kTipWidth * ImGui::GetFontSize());
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

template <class Choice, std::size_t kCount>
void choose(const char* name, Choice& choice, const std::array<const char*, kCount>& words) {
  int index = static_cast<int>(choice);
  if (ImGui::Combo(name, &index, words.data(), static_cast<int>(kCount))) choice = static_cast<Choice>(index);
}

void slide(const char* name, double& value, double from, double to, const char* format,
           ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp) {
  auto shown = static_cast<float>(value);
  if (ImGui::SliderFloat(name, &shown, static_cast<float>(from), static_cast<float>(to), format, flags)) {
    value = static_cast<double>(shown);
  }
}

void draw_surface(SurfaceLook& surface) {
  slide("Opacity", surface.alpha, 0.0, 1.0, "%.2f");
  ImGui::SetItemDefaultFocus();
  tip("How opaque the ground is; U goes through 1, 0.7 and 0.4. At 1 it is drawn once, below it twice, so that nothing "
      "of it shows through itself.");
  choose("Blend", surface.blend, std::array{"normal", "additive"});
  tip("normal: what is under the ground fades as the ground covers it. additive: it keeps its light, and bright places "
      "may saturate.");
  bool inner = surface.inner_sphere_below_m.has_value();
  if (ImGui::Checkbox("Inner sphere", &inner)) {
    surface.inner_sphere_below_m = inner ? std::optional<double>(1.0e6) : std::nullopt;
  }
  tip("Hides what lies under the far side. Without it the whole inside is seen.");
  if (surface.inner_sphere_below_m) {
    double depth_km = *surface.inner_sphere_below_m / 1e3;
    slide("Its depth", depth_km, kShallowest_km, kDeepest_km, "%.0f km");
    surface.inner_sphere_below_m = 1e3 * depth_km;
    tip("How far under the equator the inner sphere lies. The deepest earthquakes are at 700 km.");
  }
}

void draw_from_below(ViewSettings& settings) {
  ImGui::Checkbox("Eye under the ground", &settings.under_ground);
  tip("X: under the place where the eye was, looking up at the ground, and back.");
  choose("Ground from below", settings.surface.from_below, std::array{"opaque", "translucent", "selective"});
  tip("What an eye under the ground sees of it. selective lets through only objects that ask for it "
      "(\"through_surface\" in GeoJSON). Counts where Opacity is under 1.");
  choose("Horizon culling", settings.surface.horizon_culling, std::array{"auto", "on", "off"});
  tip("auto leaves out what cannot be seen. on: from below the planet's other half too, for one object nearby. off: "
      "everything in the frame is drawn.");
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
  tip("The time of day in UTC: turns the night around the globe.");
  ImGui::SliderInt("Day of the year", &of_year, 1, 365, "%d", ImGuiSliderFlags_AlwaysClamp);
  tip("Moves the Sun between the tropics, and the Moon and the stars.");
  if (hour == hour_before && of_year == day_before) return;
  set_time(settings, new_year + days{of_year - 1} + minutes{static_cast<int>(hour * 60.0)});
}

void draw_time(ViewSettings& settings) {
  if (settings.written != settings.time) set_time(settings, settings.time);
  std::array<char, 40> text{};
  settings.time_text.copy(text.data(), text.size() - 1);
  if (ImGui::InputText("Time", text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue)) {
    settings.time_text = text.data();
    const Result<UtcTime> time = parse_utc(settings.time_text);
    if (time) set_time(settings, *time);
    if (!time) settings.time_problem = time.error().message;
  }
  tip("UTC, 1950 to 2050, as 2026-06-21T12:00Z; Enter takes it. Without a time the light comes over the viewer's "
      "shoulder.");
  if (!settings.time_problem.empty()) ImGui::TextWrapped("%s", settings.time_problem.c_str());
  bool has_time = settings.time.has_value();
  if (ImGui::Checkbox("Sun, Moon and stars of a time", &has_time)) {
    set_time(settings, has_time ? std::optional<UtcTime>(kFirstTime) : std::nullopt);
  }
  tip("The lights of cities are there if the program was started with --time.");
  if (settings.time) draw_time_sliders(settings);
}

void draw_stereo(StereoLook& stereo) {
  choose("Stereo", stereo.mode, std::array{"off", "side by side", "interlaced", "anaglyph"});
  tip("S. anaglyph: red glass for the left eye, cyan for the right. interlaced: even rows for the left eye. side by "
      "side: the left eye's picture left.");
  bool by_itself = !stereo.eye_separation_m.has_value();
  if (ImGui::Checkbox("Eyes set apart by themselves", &by_itself)) {
    stereo.eye_separation_m = by_itself ? std::nullopt : std::optional<double>(1.0e5);
  }
  tip("A thirtieth of the distance to what is in the picture's middle: comfortable from orbit to street.");
  if (!stereo.eye_separation_m) return;
  double apart_km = *stereo.eye_separation_m / 1e3;
  slide("Eye separation", apart_km, 1.0e-4, 5.0e3, "%.4g km",
        ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
  stereo.eye_separation_m = 1e3 * apart_km;
  tip("More makes the relief of the scene deeper, and too much cannot be looked at.");
}

}  // namespace

std::string time_field(std::optional<UtcTime> time) {
  if (!time) return {};
  return fmt::format("{:%Y-%m-%dT%H:%MZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(*time)));
}

void draw_view_settings(ViewSettings& settings, bool just_opened) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.8F * unit, 0.8F * unit});
  ImGui::SetNextWindowSize({kWidth * unit, std::min(size.y - 5.0F * unit, 33.0F * unit)});
  ImGui::SetNextWindowBgAlpha(0.85F);
  if (just_opened) ImGui::SetNextWindowFocus();
  ImGui::Begin("View", nullptr,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushItemWidth(0.5F * kWidth * unit);
  draw_surface(settings.surface);
  ImGui::Separator();
  draw_from_below(settings);
  if (settings.has_sky) {
    ImGui::Separator();
    ImGui::Checkbox("Sky", &settings.sky);
    tip("B: stars, Sun, Moon and the air around the globe.");
    if (settings.sky) draw_time(settings);
  }
  ImGui::Separator();
  draw_stereo(settings.stereo);
  if (settings.has_relief) {
    ImGui::Separator();
    slide("Exaggeration", settings.exaggeration, 0.0, 30.0, "%.1f times");
    tip("How many times as high the ground's heights are drawn.");
  }
  ImGui::PopItemWidth();
  ImGui::End();
}

}  // namespace terrella
