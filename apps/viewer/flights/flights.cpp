#include "apps/viewer/flights/flights.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>
#include <system_error>

#include "apps/flight/flight_text.h"
#include "apps/open_scene/project/write_project.h"
#include "apps/process/write_file.h"
#include "apps/viewer/input.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/tools/screenshot.h"
#include "geo/body.h"
#include "streaming/georeference/figure.h"
#include "streaming/objects/vector/kml_file.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
constexpr float kFlightWidth = 30.0F;  // in text heights
constexpr std::array kFlightSpeeds = {0.25, 0.5, 1.0, 2.0, 4.0};
constexpr std::array kFlightSpeedNames = {"0.25x", "0.5x", "1x", "2x", "4x"};
constexpr std::array kFilmRates = {24, 25, 30, 60};
constexpr std::array kFilmRateNames = {"24 frames a second", "25 frames a second", "30 frames a second",
                                       "60 frames a second"};
constexpr std::array kFilmKinds = {"PNG frames", "MP4, by ffmpeg"};
constexpr double kLongestStep_s = 0.25;  // a slow frame does not leave out more of the way

Status write_text(const fs::path& file, const std::string& text) {
  return write_file(file, std::as_bytes(std::span(text)));
}

fs::path new_name(const char* ending) {
  std::error_code unknown;
  return new_file_name(fs::current_path(unknown), std::chrono::system_clock::now(), ending);
}

std::vector<FlightPath> flight_through(const std::vector<Camera>& views) {
  std::vector<FlightMoment> keyframes;
  keyframes.reserve(views.size());
  for (const Camera& view : views) {
    if (view.eye.height_m > 0.0) keyframes.push_back({.camera = view});
  }
  if (keyframes.size() < 2) return {};
  return {FlightPath(even_pace(keyframes), keyframes)};
}

}  // namespace

void Flights::open(const fs::path& file) {
  Result<FlightFile> read = read_flight(file);
  if (!read) return context_.messages.report(read.error().message);
  take(file.filename().string(), *std::move(read));
  if (!is_open()) toggle();
}

void Flights::take(const std::string& name, FlightFile file) {
  add({.name = name, .paths = std::move(file.paths)});
  for (const std::string& complaint : file.complaints) context_.messages.report(complaint);
}

void Flights::add(Flight flight) {
  play(false);
  const auto same = std::ranges::find(flights_, flight.name, &Flight::name);
  chosen_ = static_cast<int>(same - flights_.begin());
  if (same == flights_.end()) {
    flights_.push_back(std::move(flight));
  } else {
    *same = std::move(flight);
  }
  time_s_ = 0.0;
}

void Flights::look_into(const fs::path& file) {
  if (!is_kml_name(file) || are_two_bodies(context_.globe.options().body, earth())) return;
  looked_.push_back({file.filename().string(), std::async(std::launch::async, [file] {
                       Result<FlightFile> read = read_flight(file);
                       glfwPostEmptyEvent();
                       return read;
                     })});
}

// A file without tours is the usual one; one that cannot be read is told of by the layer.
void Flights::take_tours() {
  if (calls_.opening()) return;
  std::erase_if(looked_, [this](Looked& looked) {
    if (!looked.has_come()) return false;
    Result<FlightFile> read = looked.file.get();
    if (!read || read->paths.empty()) return true;
    take(looked.name, *std::move(read));
    say(looked.name + " has a tour: Y plays it");
    return true;
  });
}

void Flights::take_film() {
  if (!film_ || !film_->has_ended()) return;
  const Status ended = film_->end();
  const std::string folder = std::exchange(film_, nullptr)->folder().filename().string();
  ended ? say("The film is in " + folder) : context_.messages.report(ended.error().message);
}

void Flights::toggled() {
  if (!is_open()) return play(false);
  flights_.front().paths = flight_through(calls_.bookmarks());
  if (chosen().paths.empty() && flights_.size() > 1) chosen_ = static_cast<int>(flights_.size()) - 1;
  time_s_ = std::min(time_s_, chosen().paths.empty() ? 0.0 : duration_s(chosen().paths));
}

void Flights::play(bool on) {
  playing_ = on && !chosen().paths.empty();
  if (!playing_) return stand();
  if (time_s_ >= duration_s(chosen().paths)) time_s_ = 0.0;
  moved_ = Input::now();
  go(time_s_);
}

// A motion that the user has begun goes on.
void Flights::stand() {
  if (context_.navigator.is_led()) context_.navigator.set_camera(context_.navigator.camera());
}

void Flights::go(double time_s) {
  time_s_ = time_s;
  const FlightMoment moment = moment_at(chosen().paths, time_s);
  playing_ ? context_.navigator.lead(moment.camera) : context_.navigator.set_camera(moment.camera);
  const GlobeOptions& globe = context_.globe.options();
  if (moment.surface_alpha && *moment.surface_alpha != globe.surface.alpha) {
    SurfaceLook surface = globe.surface;
    surface.alpha = *moment.surface_alpha;
    context_.globe.set_surface(surface);
  }
  if (!moment.sun || moment.sun == globe.time) return;
  if (const Status set = context_.globe.set_time(moment.sun); !set) {
    play(false);
    say(set.error());
  }
}

void Flights::advance(Seconds now) {
  take_tours();
  take_film();
  if (!playing_) return;
  if (!context_.navigator.is_led()) return play(false);
  const double step_s = std::min((now - moved_).count(), kLongestStep_s);
  moved_ = now;
  const double last_s = duration_s(chosen().paths);
  double time_s = time_s_ + step_s * kFlightSpeeds[static_cast<std::size_t>(speed_)];
  if (time_s >= last_s && loops_) time_s = std::fmod(time_s, std::max(last_s, kLongestStep_s));
  playing_ = time_s < last_s;
  go(std::min(time_s, last_s));
}

bool Flights::changed() const {
  if (film_ && film_->has_ended()) return true;
  return std::ranges::any_of(looked_, [](const Looked& looked) { return looked.has_come(); });
}

std::string Flights::job() const {
  return film_ ? fmt::format("Film: {} %; Esc cancels", film_->percent()) : std::string();
}

bool Flights::cancel() {
  if (!film_) return false;
  const std::string folder = std::exchange(film_, nullptr)->folder().filename().string();
  say("Film cancelled; what there is of it is in " + folder);
  return true;
}

void Flights::draw_open(float foot) {
  const float unit = ImGui::GetFontSize(), left = 0.8F * unit;
  const float right = std::min(left + kFlightWidth * unit, ImGui::GetIO().DisplaySize.x - left);
  place_panel(Ui::panel_room(left, right, foot));
  ImGui::SetNextWindowBgAlpha(0.85F);
  if (take_just_opened()) ImGui::SetNextWindowFocus();
  begin_panel(panel());
  ImGui::PushItemWidth(0.55F * kFlightWidth * unit);
  draw_choice();
  if (chosen().paths.empty()) {
    write_wrapped("Save two views as bookmarks with Ctrl + 1 and Ctrl + 2, or open a KML file with a tour.");
  } else {
    draw_play();
    draw_film();
  }
  ImGui::PopItemWidth();
  ImGui::End();
}

void Flights::draw_choice() {
  const int before = chosen_;
  const std::string shown = panel_text(chosen().name);
  if (ImGui::BeginCombo("Flight", shown.c_str())) {
    for (std::size_t k = 0; k < flights_.size(); ++k) {
      ImGui::PushID(static_cast<int>(k));
      if (ImGui::Selectable(panel_text(flights_[k].name).c_str(), chosen_ == static_cast<int>(k))) {
        chosen_ = static_cast<int>(k);
      }
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  tip("A way through the bookmarks in the order of their numbers, without views under the ground; or the tour of a "
      "file.");
  if (chosen_ == before) return;
  play(false);
  time_s_ = 0.0;
}

void Flights::draw_play() {
  const double last_s = duration_s(chosen().paths);
  constexpr double kStart = 0.0;
  double time_s = time_s_;
  ImGui::SetNextItemWidth(-1.0F);
  const std::string text = fmt::format("{:.1f} of {:.1f} s", time_s_, last_s);
  if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &time_s, &kStart, &last_s, text.c_str(),
                          ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput)) {
    playing_ = false;
    go(time_s);
  }
  tip("Seconds from the first view on.");
  if (ImGui::Button(playing_ ? "Pause###play" : "Play###play") || entered()) play(!playing_);
  tip("Flies; moving the globe pauses the flight.");
  beside_if_room("Start");
  if (ImGui::Button("Start") || entered()) {
    playing_ = false;
    go(0.0);
  }
  tip("Shows the first view.");
  beside_if_room("Loop      ");
  ImGui::Checkbox("Loop", &loops_);
  tip("Begins again at the end.");
  ImGui::Combo("Speed", &speed_, kFlightSpeedNames.data(), static_cast<int>(kFlightSpeedNames.size()));
  tip("Of the flight in the window; a film has the flight's own times.");
}

void Flights::draw_film() {
  group("Film");
  ImGui::Combo("Rate", &rate_, kFilmRateNames.data(), static_cast<int>(kFilmRateNames.size()));
  choose("Kind", one_file_, kFilmKinds);
  if (film_) {
    write_wrapped(job());
  } else if (ImGui::Button("Save film") || entered()) {
    save_film();
  }
  tip("Renders the film in the window's size beside the window's work, into a new folder where the program was "
      "started. "
      "Each frame has all its tiles.");
  if (!film_) beside_if_room("Save flight");
  if (ImGui::Button("Save flight") || entered()) save_flight();
  tip("Saves the flight as GeoJSON, which terrella render --flight and preload --flight read.");
}

void Flights::save_flight() {
  const fs::path file = new_name(".geojson");
  const Status saved = write_text(file, flight_text(chosen().paths));
  saved ? say("Saved " + file.filename().string()) : say(saved.error());
}

// The folder has all that the film is made from, so that the command can be repeated.
void Flights::save_film() {
  const fs::path folder = new_name("-film");
  std::error_code failed;
  fs::create_directory(folder, failed);
  if (failed) return say(Error{folder.string() + ": cannot be made: " + failed.message()});
  const SceneOptions scene = calls_.scene();
  const ProjectText project = project_text(scene, folder);
  const fs::path scene_file = folder / "scene.terrella", flight_file = folder / "flight.geojson";
  Status saved = write_text(scene_file, project.text);
  if (saved) saved = write_text(flight_file, flight_text(chosen().paths));
  if (!saved) return say(saved.error());
  const Viewport size = scene.size;
  const int by = one_file_ ? 2 : 1;  // a film in MP4 has even sides
  auto film = FilmJob::start(folder, {scene_file.string(), "--flight", flight_file.string(), "--fps",
                                      std::to_string(kFilmRates[static_cast<std::size_t>(rate_)]), "--size",
                                      fmt::format("{}x{}", size.width_px / by * by, size.height_px / by * by), "-o",
                                      (folder / (one_file_ ? "film.mp4" : "%05d.png")).string()});
  if (!film) return say(film.error());
  film_ = *std::move(film);
  for (const std::string& left_out : project.left_out) context_.messages.report(left_out);
}

}  // namespace terrella
