#include "apps/viewer/flights/flights.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <system_error>

#include "apps/flight/flight_text.h"
#include "apps/open_scene/project/write_project.h"
#include "apps/viewer/input.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/tools/kept_json.h"
#include "apps/viewer/tools/screenshot.h"
#include "geo/body.h"
#include "streaming/georeference/figure.h"
#include "streaming/objects/vector/kml_file.h"
#include "view/flight.h"

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
constexpr double kLongestFlightStep_s = 0.25;  // a slow frame does not leave out more of the way

fs::path new_name(const char* ending) {
  std::error_code unknown;
  return new_file_name(fs::current_path(unknown), std::chrono::system_clock::now(), ending);
}

/// The way through views as the window flies to bookmarks, but slower and with a rest at each. Without the views below
/// the ellipsoid, which a flight has not.
std::vector<FlightPath> flight_through(std::vector<Camera> views, const Ellipsoid& body) {
  constexpr double kSlower = 4.0, kRest_s = 1.0;
  constexpr int kSteps = 16;  // keyframes of a way, which climbs
  std::erase_if(views, [](const Camera& view) { return view.eye.height_m <= 0.0; });
  if (views.size() < 2) return {};
  std::vector<double> times{0.0};
  std::vector<FlightMoment> keyframes{{.camera = views.front()}};
  for (std::size_t k = 1; k < views.size(); ++k) {
    const terrella::Flight way = plan_flight(views[k - 1], views[k], body);
    const double begin_s = times.back();
    for (int step = 1; step <= kSteps; ++step) {
      const Seconds at = way.duration * double(step) / double(kSteps);
      times.push_back(begin_s + kSlower * at.count());
      keyframes.push_back({.camera = flight_camera(way, at)});
    }
    if (k + 1 == views.size()) break;
    times.push_back(times.back() + kRest_s);
    keyframes.push_back(keyframes.back());
  }
  return {FlightPath(std::move(times), keyframes)};
}

}  // namespace

void Flights::open(const fs::path& file) {
  Result<FlightFile> read = read_flight(file);
  if (!read) return context_.messages.report(read.error().message);
  take(add(file, *std::move(read)));
  if (!is_open()) toggle();
}

int Flights::add(const fs::path& file, FlightFile read) {
  for (const std::string& complaint : read.complaints) context_.messages.report(complaint);
  const auto same = std::ranges::find(flights_, file, &Flight::file);
  const int index = static_cast<int>(same - flights_.begin());
  if (index == chosen_) take(index);
  if (same == flights_.end()) {
    flights_.push_back({file, std::move(read.paths)});
  } else {
    same->paths = std::move(read.paths);
  }
  return index;
}

void Flights::take(int flight) {
  play(false);
  restore_scene();
  chosen_ = flight;
  time_s_ = 0.0;
}

void Flights::look_into(const fs::path& file, bool tell) {
  if (!is_kml_name(file) || are_two_bodies(context_.globe.options().body, earth())) return;
  looked_.push_back({file, tell, std::async(std::launch::async, [file] {
                       Result<FlightFile> read = read_flight(file);
                       glfwPostEmptyEvent();
                       return read;
                     })});
}

// Most files have no tours, and the layer tells of a file that cannot be read.
void Flights::take_tours() {
  if (calls_.opening()) return;
  std::erase_if(looked_, [this](Looked& looked) {
    if (!looked.has_come()) return false;
    Result<FlightFile> read = looked.file.get();
    if (!read || read->paths.empty()) return true;
    const int index = add(looked.path, *std::move(read));
    if (!playing_ && chosen_ == 0) take(index);
    if (looked.tell) say(looked.path.filename().string() + " has a tour: Y opens it");
    return true;
  });
}

void Flights::take_film() {
  shown_job_ = job();
  if (!film_ || !film_->has_ended()) return;
  const Result<std::string> ended = std::exchange(film_, nullptr)->end();
  ended ? say(*ended) : context_.messages.report(ended.error().message);
}

std::string Flights::job() const {
  if (!film_) return {};
  return film_->is_stopped() ? "The film ends" : fmt::format("Film: {} %", film_->percent());
}

bool Flights::may_quit() {
  if (!film_ || film_->is_stopped() || std::exchange(warned_, true)) return true;
  say("A film is being rendered. Quit again to cancel it.");
  return false;
}

void Flights::refresh_bookmarks() {
  if (chosen_ == 0) play(false);
  flights_.front().paths = flight_through(calls_.bookmarks(), context_.globe.options().body.ellipsoid);
  if (chosen_ == 0 && !chosen().paths.empty()) time_s_ = std::min(time_s_, duration_s(chosen().paths));
}

void Flights::toggled() {
  play(false);
  if (!is_open()) return restore_scene();
  refresh_bookmarks();
  if (chosen().paths.empty()) take(static_cast<int>(flights_.size()) - 1);
}

// A setting that the user has changed since is the user's.
void Flights::forget_users_settings() {
  const GlobeOptions& globe = context_.globe.options();
  if (alpha_ && alpha_->by != globe.surface.alpha) alpha_.reset();
  if (time_ && time_->by != globe.time) time_.reset();
}

void Flights::put_back(SceneOptions& scene) const {
  if (alpha_ && alpha_->by == scene.surface.alpha) scene.surface.alpha = alpha_->before;
  if (time_ && time_->by == scene.time) scene.time = time_->before;
}

void Flights::restore_scene() { show_look({}, {}); }

// Without an opacity or time of the moment the scene has its own.
void Flights::show_look(std::optional<double> alpha, std::optional<UtcTime> sun) {
  forget_users_settings();
  const GlobeOptions& globe = context_.globe.options();
  if (alpha || alpha_) {
    const double before = alpha_ ? alpha_->before : globe.surface.alpha;
    SurfaceLook surface = globe.surface;
    surface.alpha = alpha.value_or(before);
    if (surface.alpha != globe.surface.alpha) context_.globe.set_surface(surface);
    alpha_ = alpha ? std::optional<Replaced<double>>({before, *alpha}) : std::nullopt;
  }
  if (!sun && !time_) return;
  const std::optional<UtcTime> before = time_ ? time_->before : globe.time, wanted = sun ? sun : before;
  const Status set = wanted != globe.time ? context_.globe.set_time(wanted) : Status(Done{});
  time_ = sun && set ? std::optional<Replaced<std::optional<UtcTime>>>({before, sun}) : std::nullopt;
  if (set) return;
  play(false);
  say(set.error());
}

void Flights::play(bool on) {
  playing_ = on && !chosen().paths.empty();
  if (!playing_) return stand();
  if (time_s_ >= duration_s(chosen().paths)) time_s_ = 0.0;
  moved_ = Input::now();
  go(time_s_);
}

// The user's own motion goes on.
void Flights::stand() {
  if (context_.navigator.is_led()) context_.navigator.set_camera(context_.navigator.camera());
}

void Flights::go(double time_s) {
  time_s_ = time_s;
  const FlightMoment moment = moment_at(chosen().paths, time_s);
  playing_ ? context_.navigator.lead(moment.camera) : context_.navigator.set_camera(moment.camera);
  show_look(moment.surface_alpha, moment.sun);
}

void Flights::advance(Seconds now) {
  take_tours();
  take_film();
  if (!playing_) return;
  if (!context_.navigator.is_led()) return play(false);
  const double step_s = std::min((now - moved_).count(), kLongestFlightStep_s);
  moved_ = now;
  const double last_s = duration_s(chosen().paths);
  double time_s = time_s_ + step_s * kFlightSpeeds[static_cast<std::size_t>(speed_)];
  if (time_s >= last_s && loops_ && last_s > 0.0) time_s = std::fmod(time_s, last_s);
  playing_ = time_s < last_s;
  go(std::min(time_s, last_s));
}

bool Flights::changed() const {
  if (job() != shown_job_ || (film_ && film_->has_ended())) return true;
  return !calls_.opening() && std::ranges::any_of(looked_, &Looked::has_come);
}

void Flights::draw_open(float foot) {
  begin_left_panel(panel(), kFlightWidth, foot, take_just_opened());
  ImGui::PushItemWidth(0.55F * kFlightWidth * ImGui::GetFontSize());
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
  int wanted = chosen_;
  const std::string shown = panel_text(chosen().name());
  if (ImGui::BeginCombo("Flight", shown.c_str())) {
    for (std::size_t k = 0; k < flights_.size(); ++k) {
      ImGui::PushID(static_cast<int>(k));
      const bool is_chosen = chosen_ == static_cast<int>(k);
      if (ImGui::Selectable(panel_text(flights_[k].name()).c_str(), is_chosen)) wanted = static_cast<int>(k);
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  tip("A way through the bookmarks in the order of their numbers, without views under the ground; or the tour of a "
      "file.");
  if (wanted != chosen_) take(wanted);
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
    if (ImGui::Button("Cancel film") || entered()) film_->stop();
  } else if (ImGui::Button("Save film") || entered()) {
    save_film();
  }
  tip("Renders the film in the window's size beside the window's work, into a new folder where the program was "
      "started. "
      "Each frame has all its tiles.");
  beside_if_room("Save flight");
  if (ImGui::Button("Save flight") || entered()) save_flight();
  tip("Saves the flight as GeoJSON, which terrella render --flight and preload --flight read.");
}

void Flights::save_flight() {
  const fs::path file = new_name(".geojson");
  const Status saved = write_kept_text(file, flight_text(chosen().paths));
  saved ? say("Saved " + file.filename().string()) : say(saved.error());
}

// The names are as the process's own folder sees them, so that the command in film.log goes on with the film there.
void Flights::save_film() {
  const fs::path whole = new_name("-film"), folder = whole.filename();
  std::error_code failed;
  fs::create_directory(folder, failed);
  if (failed) return say(Error{whole.string() + " cannot be made: start the program in a folder that can be written"});
  const SceneOptions scene = calls_.scene();
  const ProjectText project = project_text(scene, whole);
  for (const std::string& left_out : project.left_out) context_.messages.report("Not in the film: " + left_out);
  const fs::path scene_file = folder / "scene.terrella", flight_file = folder / "flight.geojson";
  Status saved = write_kept_text(scene_file, project.text);
  if (saved) saved = write_kept_text(flight_file, flight_text(chosen().paths));
  auto film = saved ? FilmJob::start(folder, film_arguments(scene, scene_file, flight_file)) : saved.error();
  if (!film) {
    fs::remove_all(folder, failed);
    return say(film.error());
  }
  film_ = *std::move(film);
  warned_ = false;
}

std::vector<std::string> Flights::film_arguments(const SceneOptions& scene, const fs::path& scene_file,
                                                 const fs::path& flight_file) const {
  const int by = one_file_ ? 2 : 1;  // a film in MP4 has even sides
  const fs::path output = scene_file.parent_path() / (one_file_ ? "film.mp4" : "%05d.png");
  std::vector<std::string> arguments = {
      scene_file.string(),
      "--flight",
      flight_file.string(),
      "--fps",
      std::to_string(kFilmRates[static_cast<std::size_t>(rate_)]),
      "--size",
      fmt::format("{}x{}", scene.size.width_px / by * by, scene.size.height_px / by * by),
      "--credits",
      "--memory",
      std::to_string(scene.memory_mb),
      "--cache-size",
      std::to_string(scene.base.cache_size_mb),
      "--timeout",
      fmt::format("{}", scene.base.timeout_s)};
  if (!scene.base.cache.empty()) arguments.insert(arguments.end(), {"--cache", scene.base.cache});
  if (scene.base.offline) arguments.emplace_back("--offline");
  arguments.insert(arguments.end(), {"-o", output.string()});
  return arguments;
}

}  // namespace terrella
