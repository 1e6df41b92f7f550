#include "apps/viewer/viewer.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise brings its own gl.h
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <utility>

#include "apps/data_dir.h"
#include "apps/viewer/screenshot.h"
#include "scene/stereo.h"

namespace terrella {
namespace {

constexpr std::chrono::seconds kMessageTime(4);
constexpr double kLoadingPause_s = 1.0 / 60.0;  // between looks at what has come
constexpr double kIdlePause_s = 1.0;            // what could not be had is asked for again
constexpr double kScaleBar_px = 150.0;          // at 96 dots per inch
constexpr double kEarthEquator_m = 6378137.0;
constexpr int kPanelFrames = 3;
constexpr double kPlaceHeight = 0.05;  // in radii, over a place that was found
constexpr double kFoot = 3.4;          // of the text's height, that the panels below take

// Without the list of places the globe is there all the same.
Gazetteer load_places() {
  try {
    Result<Gazetteer> places = Gazetteer::load(data_file("populated_places_110m.geojson"));
    if (places) return *std::move(places);
  } catch (const BrokenInstallation&) {
  }
  return {};
}

}  // namespace

Viewer::Viewer(Window& window, Globe& globe, const ViewerOptions& options)
    : window_(window),
      globe_(globe),
      options_(options),
      ui_(window),
      navigator_(options.camera, globe.ground(), window.framebuffer()),
      input_(window, ui_, navigator_) {
  if (options.camera.eye.height_m < 0.0) navigator_.set_deepest(deepest_m());
}

void Viewer::run() {
  while (glfwWindowShouldClose(window_.handle()) == GLFW_FALSE) {
    wait_for_work();
    for (const ViewerAction action : input_.take_actions()) act(action);
    if (const auto click = input_.take_click(); click && measuring_) measure_at(*click);
    if (const auto bookmark = input_.take_bookmark()) use(*bookmark);
    const Viewport framebuffer = window_.framebuffer();
    if (framebuffer.width_px <= 0 || framebuffer.height_px <= 0) continue;
    const bool dirty = input_.take_dirty();
    if (panel_frames_ > 0) --panel_frames_;
    if (dirty && (panel_ || searching_)) panel_frames_ = kPanelFrames;
    navigator_.set_viewport(framebuffer);
    navigator_.advance(Input::now());
    draw_frame(framebuffer);
    print_camera_at_rest();
  }
}

// Whether another frame would show something else.
bool Viewer::work() const {
  return input_.dirty() || panel_frames_ > 0 || navigator_.animating() || screenshot_wanted_ || globe_.needs_frame() ||
         (!message_.empty() && Clock::now() >= message_until_) || glfwWindowShouldClose(window_.handle()) == GLFW_TRUE;
}

void Viewer::wait_for_work() {
  if (work()) return input_.listen();
  const double pause_s = globe_.settled() ? kIdlePause_s : kLoadingPause_s;
  do {
    const std::chrono::duration<double> message_left = message_until_ - Clock::now();
    input_.listen(message_.empty() ? pause_s : std::clamp(message_left.count(), 0.001, pause_s));
  } while (!work());
}

void Viewer::act(ViewerAction action) {
  switch (action) {
    case ViewerAction::toggle_help:
      help_ = !help_;
      return;
    case ViewerAction::toggle_graticule:
      graticule_ = !graticule_;
      return;
    case ViewerAction::toggle_panel:
      return toggle_panel();
    case ViewerAction::toggle_full_screen:
      window_.toggle_full_screen();
      return;
    case ViewerAction::save_screenshot:
      screenshot_wanted_ = true;
      return;
    case ViewerAction::next_alpha:
      return next_alpha();
    case ViewerAction::next_stereo:
      return next_stereo();
    case ViewerAction::toggle_sky:
      sky_ = !sky_;
      globe_.set_sky(sky_);
      say(sky_ ? "Sky" : "No sky");
      return;
    case ViewerAction::toggle_underground:
      return toggle_underground();
    case ViewerAction::toggle_measuring:
      return toggle_measuring();
    case ViewerAction::measure_middle:
      if (measuring_) measure_at(0.5 * glm::dvec2(window_.framebuffer().width_px, window_.framebuffer().height_px));
      return;
    case ViewerAction::take_back:
      measure_.take_back();
      return draw_measure();
    case ViewerAction::find_place:
      return toggle_search();
    case ViewerAction::leave:
      if (searching_) return toggle_search();
      if (panel_) return toggle_panel();
      if (measuring_) return toggle_measuring();
      glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE);
      return;
  }
}

void Viewer::next_alpha() {
  constexpr double kAlphas[] = {1.0, 0.7, 0.4};
  SurfaceLook surface = globe_.options().surface;
  const auto* lower =
      std::find_if(std::begin(kAlphas), std::end(kAlphas), [&](double alpha) { return alpha < surface.alpha - 0.01; });
  surface.alpha = lower == std::end(kAlphas) ? kAlphas[0] : *lower;
  globe_.set_surface(surface);
  say(fmt::format("Surface {:.0f} % opaque", 100.0 * surface.alpha));
}

void Viewer::next_stereo() {
  StereoLook stereo = globe_.options().stereo;
  switch (stereo.mode) {
    case Stereo::off:
      stereo.mode = Stereo::anaglyph;
      say("Stereo: anaglyph, red for the left eye");
      break;
    case Stereo::anaglyph:
      stereo.mode = Stereo::side_by_side;
      say("Stereo: side by side");
      break;
    case Stereo::side_by_side:
      stereo.mode = Stereo::interlaced;
      say("Stereo: interlaced, even rows for the left eye");
      break;
    case Stereo::interlaced:
      stereo.mode = Stereo::off;
      say("Stereo off");
      break;
  }
  globe_.set_stereo(stereo);
}

// Most of the way down to the inner sphere.
double Viewer::deepest_m() const {
  constexpr double kDeepest = 0.8;
  const Ellipsoid& e = globe_.options().body.ellipsoid;
  const double below_m = globe_.options().surface.inner_sphere_below_m.value_or(kEarthEquator_m);
  return -kDeepest * below_m * (e.a_m() / kEarthEquator_m);
}

// Under the place where it was, as deep as it was high but over the inner sphere, looking up at the ground.
void Viewer::toggle_underground() {
  Camera camera = navigator_.camera();
  const double ground_m = globe_.ground_height_m(camera.eye.lat, camera.eye.lon);
  if (above_ || camera.eye.height_m < ground_m) {
    camera.eye.height_m = 2.0 * ground_m - camera.eye.height_m;
    camera.pitch = Angle::degrees(-90.0);
    if (above_) camera = *std::exchange(above_, std::nullopt);
    navigator_.set_deepest({});
    say("Over the ground");
  } else {
    above_ = camera;
    navigator_.set_deepest(deepest_m());
    camera.eye.height_m = std::max(2.0 * ground_m - camera.eye.height_m, deepest_m());
    camera.pitch = Angle::degrees(std::max(30.0, -camera.pitch.deg()));
    say("Under the ground; X goes back");
  }
  navigator_.set_camera(camera);
}

// What was measured goes when measuring ends.
void Viewer::toggle_measuring() {
  measuring_ = !measuring_;
  input_.set_double_clicks(!measuring_);
  measure_.clear();
  draw_measure();
}

void Viewer::measure_at(glm::dvec2 px) {
  auto place = pick(globe_.view(window_.framebuffer()), globe_.ground(), px);
  if (!place) return say("There is no ground to measure from");
  if (!globe_.has_relief()) place->height_m = 0.0;  // what rounding leaves would be under the ground
  measure_.add(*place);
  draw_measure();
}

void Viewer::draw_measure() {
  ObjectScene scene = measure_.scene(globe_.options().body.ellipsoid);
  Status drawn = Done{};
  if (measure_layer_) {
    drawn = globe_.set_objects(*measure_layer_, std::move(scene));
  } else if (!scene.empty()) {
    const Result<LayerId> layer = globe_.add_objects(std::move(scene));
    if (layer) measure_layer_ = *layer;
    if (!layer) drawn = layer.error();
  }
  if (!drawn) say(drawn.error().message);
}

// The file is read anew each time: another window may have set one. A damaged one is left as it is.
void Viewer::use(const BookmarkKey& key) {
  const auto file = bookmarks_file();
  if (file) {
    Result<Bookmarks> kept = Bookmarks::load(*file);
    if (!kept) return say(kept.error().message);
    bookmarks_ = *std::move(kept);
  }
  const std::optional<Camera>& there = bookmarks_.at(key.number);
  if (!key.set && !there) return say(fmt::format("No bookmark {0} yet; Ctrl + {0} sets it", key.number));
  if (!key.set) return navigator_.fly_to(*there, Input::now());
  bookmarks_.set(key.number, navigator_.camera());
  const Status saved = file ? bookmarks_.save(*file) : Status(Error{"Kept until the window closes: HOME is not set"});
  say(saved ? fmt::format("Bookmark {}", key.number) : saved.error().message);
}

const Gazetteer& Viewer::places() {
  if (!places_) places_ = load_places();
  return *places_;
}

void Viewer::toggle_search() {
  searching_ = !searching_ && places().size() > 0;
  if (places().size() == 0) say("The program was installed without its list of places");
  if (!searching_) ui_.expect_text(false);
  search_ = {.text = {}, .just_opened = searching_};
  ui_.take_events(panel_ || searching_);
  panel_frames_ = kPanelFrames;
}

void Viewer::draw_search() {
  const auto chosen = draw_place_search(search_, places());
  if (!chosen) return;
  toggle_search();
  Camera camera = navigator_.camera();
  camera.eye = chosen->place;
  camera.eye.height_m = kPlaceHeight * globe_.options().body.ellipsoid.a_m();
  camera.heading = Angle{};
  camera.pitch = Angle::degrees(-90.0);
  navigator_.fly_to(camera, Input::now());
  say(chosen->country.empty() ? chosen->name : chosen->name + ", " + chosen->country);
}

void Viewer::toggle_panel() {
  panel_ = !panel_;
  ui_.take_events(panel_ || searching_);
  panel_opened_ = panel_;
  panel_frames_ = kPanelFrames;
  const GlobeOptions& options = globe_.options();
  settings_.has_sky = options.sky;
  settings_.has_relief = globe_.has_relief();
  settings_.exaggeration = options.exaggeration;
}

// What keys have changed since is in the globe.
void Viewer::draw_settings() {
  const GlobeOptions& options = globe_.options();
  settings_.surface = options.surface;
  settings_.stereo = options.stereo;
  settings_.sky = sky_;
  settings_.under_ground = above_.has_value();
  const std::optional<UtcTime> time = settings_.time = options.time;
  draw_view_settings(settings_, std::exchange(panel_opened_, false));
  globe_.set_surface(settings_.surface);
  globe_.set_stereo(settings_.stereo);
  globe_.set_sky(sky_ = settings_.sky);
  if (settings_.under_ground != above_.has_value()) toggle_underground();
  if (settings_.exaggeration != options.exaggeration) globe_.set_exaggeration(settings_.exaggeration);
  if (settings_.time == time) return;
  const Status set = globe_.set_time(settings_.time);
  settings_.time_problem = set ? "" : set.error().message;
}

// Each eye's own lines; the rows of interlaced pictures are too few for two.
void Viewer::draw_graticules(const View& view) {
  const Ellipsoid& body = globe_.options().body.ellipsoid;
  const double unit_px = window_.pixels_per_unit().x, text_px = Ui::text_height() * unit_px;
  const LabelSize label{.character_px = 0.62 * text_px, .line_px = 1.2 * text_px, .foot_px = kFoot * text_px};
  const StereoLook& stereo = globe_.options().stereo;
  if (stereo.mode == Stereo::off || stereo.mode == Stereo::interlaced) {
    return draw_graticule(make_graticule(view, body, label), {.size = view.viewport}, unit_px);
  }
  const bool halves = stereo.mode == Stereo::side_by_side;
  Viewport size = view.viewport;
  if (halves) size.width_px = std::max(1, size.width_px / 2);
  const EyePair eyes = stereo_eyes(globe_.view(size), body, stereo);
  GraticulePart left{.size = size}, right{.left_px = halves ? size.width_px : 0, .size = size};
  if (!halves) left.tint = {1.0F, 0.0F, 0.0F};
  if (!halves) right.tint = {0.0F, 1.0F, 1.0F};
  draw_graticule(make_graticule(eyes.left, body, label), left, unit_px);
  draw_graticule(make_graticule(eyes.right, body, label), right, unit_px);
}

void Viewer::draw_frame(Viewport framebuffer) {
  const auto start = Clock::now();
  draw_globe(framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, framebuffer.width_px, framebuffer.height_px);
  draw_panels(framebuffer);
  if (std::exchange(screenshot_wanted_, false)) save_screenshot(framebuffer);
  glfwSwapBuffers(window_.handle());
  frame_time_ = Clock::now() - start;
}

void Viewer::draw_globe(Viewport framebuffer) {
  globe_.set_camera(navigator_.camera());
  const bool resized =
      !picture_ || picture_size_.width_px != framebuffer.width_px || picture_size_.height_px != framebuffer.height_px;
  if (resized) picture_.emplace(picture_size_ = framebuffer);
  if (resized || globe_.needs_frame()) stats_ = globe_.render(picture_->framebuffer(), framebuffer);
  glBlitNamedFramebuffer(picture_->framebuffer(), 0, 0, 0, framebuffer.width_px, framebuffer.height_px, 0, 0,
                         framebuffer.width_px, framebuffer.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Viewer::draw_panels(Viewport framebuffer) {
  const View view = globe_.view(framebuffer);
  const double unit_px = window_.pixels_per_unit().x;
  if (!message_.empty() && Clock::now() >= message_until_) message_.clear();
  ui_.begin_frame();
  if (graticule_) draw_graticules(view);
  draw_status(status(view), unit_px);
  if (panel_) draw_settings();
  if (searching_) draw_search();
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
  status.eye = "Eye " + length_text(camera.eye.height_m);
  if (stats_.tiles_missing > 0) status.tiles = fmt::format("{} tiles loading", stats_.tiles_missing);
  status.frame = fmt::format("{:.0f} ms", frame_time_.count());
  status.message = message_;
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
  message_ = std::move(message);
  message_until_ = Clock::now() + kMessageTime;
}

void Viewer::print_camera_at_rest() {
  if (!options_.print_camera || !navigator_.at_rest()) return;
  std::string text = camera_text(navigator_.camera());
  if (text == printed_camera_) return;
  printed_camera_ = std::move(text);
  fmt::print("{}\n", printed_camera_);
  std::fflush(stdout);
}

}  // namespace terrella
