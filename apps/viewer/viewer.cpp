#include "apps/viewer/viewer.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "apps/setup/console.h"
#include "apps/viewer/tools/screenshot.h"

namespace terrella {
namespace {

constexpr std::chrono::seconds kMessageTime(4);
constexpr std::chrono::milliseconds kCharacterTime(50);  // reading time per character of a message
constexpr std::chrono::seconds kHintTime(30);
constexpr const char* kHint = "Drag to turn the globe, use the wheel to zoom. P opens settings, F1 lists shortcuts.";
constexpr double kLoadingPause_s = 1.0 / 60.0;  // between checks for arrived tiles
constexpr double kIdlePause_s = 1.0;            // between retries of failed tiles
constexpr double kScaleBar_px = 150.0;          // at 96 dots per inch

}  // namespace

Viewer::Viewer(Window& window, Globe& globe, const ViewerOptions& options)
    : window_(window),
      globe_(globe),
      options_(options),
      ui_(window),
      navigator_(options.camera, globe.ground(), window.framebuffer()),
      input_(window, ui_, navigator_),
      layers_(options.layers),
      dropped_(options.files) {
  if (options.camera.eye.height_m < 0.0) navigator_.set_deepest(deepest_m());
  begin_as_kept();
  if (options.first_run) say(kHint, kHintTime);
  if (!options.message.empty()) say(options.message);
}

void Viewer::begin_as_kept() {
  const KeptSettings& start = options_.start;
  globe_.set_sky(sky_ = start.sky);
  graticule_ = start.graticule;
  if (start.panel) toggle_panel();
  if (start.layers) toggle_layers();
  saved_ = options_.kept;
  started_ = now_kept();
}

KeptSettings Viewer::now_kept() const {
  const GlobeOptions& globe = globe_.options();
  const Viewport size = window_.windowed();
  return {.width_px = size.width_px,
          .height_px = size.height_px,
          .panel = panel_,
          .layers = layers_shown_,
          .graticule = graticule_,
          .sky = sky_,
          .opacity = globe.surface.alpha,
          .exaggeration = globe.exaggeration,
          .stereo = globe.stereo.mode};
}

// Saves the settings. A failure is reported once, because the settings then count as saved.
void Viewer::keep_settings() {
  const KeptSettings now = changed_since(options_.kept, started_, now_kept());
  if (now == saved_) return;
  saved_ = now;
  const auto file = settings_file();
  if (!file) return;
  if (const Status saved = save_settings(*file, now); !saved) say(saved.error().message);
}

void Viewer::run() {
  while (glfwWindowShouldClose(window_.handle()) == GLFW_FALSE) {
    wait_for_work();
    for (const ViewerAction action : input_.take_actions()) act(action);
    for (const glm::dvec2 click : input_.take_clicks()) {
      if (measuring_) measure_at(click);
    }
    if (const auto bookmark = input_.take_bookmark()) use(*bookmark);
    take_dropped();
    const Viewport framebuffer = window_.framebuffer();
    if (framebuffer.width_px <= 0 || framebuffer.height_px <= 0) continue;
    const bool dirty = input_.take_dirty();
    if (panel_frames_ > 0) --panel_frames_;
    if ((dirty || ui_.has_waiting()) && any_panel()) show_panels();
    navigator_.set_viewport(framebuffer);
    navigator_.advance(Input::now());
    draw_frame(framebuffer);
    print_camera_at_rest();
  }
  keep_settings();
}

// True if another frame would differ.
bool Viewer::work() const {
  if (input_.dirty() || ui_.has_waiting() || panel_frames_ > 0 || navigator_.animating() || screenshot_wanted_)
    return true;
  if (dropped_.ready() || dropped_.text() != dropped_text_) return true;
  if (picture_job_ ? picture_job_->ready() : globe_.needs_frame()) return true;
  return (!message_.empty() && Clock::now() >= message_until_) || glfwWindowShouldClose(window_.handle()) == GLFW_TRUE;
}

void Viewer::wait_for_work() {
  if (work()) return input_.listen();
  keep_settings();
  const double pause_s = globe_.settled() && !picture_job_ && !dropped_.busy() ? kIdlePause_s : kLoadingPause_s;
  do {
    const std::chrono::duration<double> message_left = message_until_ - Clock::now();
    input_.listen(message_.empty() ? pause_s : std::clamp(message_left.count(), 0.001, pause_s));
  } while (!work());
}

void Viewer::draw_frame(Viewport framebuffer) {
  const auto start = Clock::now();
  picture_job_ ? draw_picture(framebuffer) : draw_globe(framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, framebuffer.width_px, framebuffer.height_px);
  draw_panels(framebuffer);
  // A newly opened panel is not drawn yet.
  if (panel_frames_ == 0 && std::exchange(screenshot_wanted_, false)) save_screenshot(framebuffer);
  glfwSwapBuffers(window_.handle());
  frame_time_ = Clock::now() - start;
}

void Viewer::draw_globe(Viewport framebuffer) {
  globe_.set_camera(navigator_.camera());
  const bool resized = !picture_ || picture_size_ != framebuffer;
  if (resized) picture_.emplace(picture_size_ = framebuffer);
  if (resized || globe_.needs_frame()) stats_ = globe_.render(picture_->framebuffer(), framebuffer);
  if (!globe_.status()) say(globe_.status().error().message);
  glBlitNamedFramebuffer(picture_->framebuffer(), 0, 0, 0, framebuffer.width_px, framebuffer.height_px, 0, 0,
                         framebuffer.width_px, framebuffer.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Viewer::draw_panels(Viewport framebuffer) {
  const View view = globe_.view(framebuffer);
  const double unit_px = window_.pixels_per_unit().x;
  if (!message_.empty() && Clock::now() >= message_until_) message_.clear();
  dropped_text_ = dropped_.text();
  ui_.begin_frame();
  if (graticule_ && !picture_job_) draw_graticules(view);
  if (!help_) draw_status(status(view), unit_px);
  if (panel_) draw_settings();
  if (searching_) draw_search();
  if (layers_shown_) draw_layer_panel();
  if (picture_panel_shown_) draw_picture_panel();
  if (help_) draw_help();
  ui_.end_frame();
}

PanelStatus Viewer::status(const View& view) const {
  const Ground ground = globe_.ground();
  PanelStatus status;
  const auto cursor = input_.cursor_px();
  if (const auto place = cursor ? pick(view, ground, *cursor) : std::nullopt) {
    status.cursor = place_text(*place, pixel_step_deg(view, ground));
    const auto elevation_m = globe_.elevation_m(place->lat, place->lon);
    if (elevation_m) status.cursor += "   " + length_text(std::round(*elevation_m));
  }
  const Camera& camera = navigator_.camera();
  status.eye = "Altitude " + length_text(camera.eye.height_m);
  if (stats_.tiles_pending > 0) status.tiles = fmt::format("{} tiles loading", stats_.tiles_pending);
  status.frame = fmt::format("{:.0f} ms", frame_time_.count());
  status.message = message_;
  status.job = dropped_text_;
  if (picture_job_) status.job = picture_job_->text();
  if (measuring_) status.measure = measure_.text(globe_.options().body.ellipsoid);
  status.attribution = fmt::format("{}", fmt::join(globe_.attributions(), "   "));
  status.scale = scale_bar(view, ground, kScaleBar_px * window_.text_scale());
  return status;
}

void Viewer::save_screenshot(Viewport framebuffer) {
  std::error_code unknown;
  const auto file = screenshot_name(std::filesystem::current_path(unknown), std::chrono::system_clock::now());
  const Status saved = save_back_buffer(file, framebuffer);
  say(saved ? "Saved " + file.filename().string() : saved.error().message);
}

void Viewer::say(std::string message) {
  const auto time = kMessageTime + kCharacterTime * message.size();
  say(std::move(message), time);
}

void Viewer::say(std::string message, Clock::duration time) {
  message_ = std::move(message);
  message_until_ = Clock::now() + time;
}

void Viewer::print_camera_at_rest() {
  if (!options_.print_camera || !navigator_.at_rest()) return;
  std::string text = camera_text(navigator_.camera());
  if (text == printed_camera_) return;
  printed_camera_ = std::move(text);
  print_result("{}\n", printed_camera_);
  std::fflush(stdout);
}

}  // namespace terrella
