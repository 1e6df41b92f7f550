#include "apps/viewer/viewer.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "apps/viewer/tools/screenshot.h"
#include "view/stereo.h"

namespace terrella {
namespace {

constexpr int kPanelFrames = 3;  // a panel shows an event one frame later
constexpr double kFoot = 3.4;    // in text heights, for the panels below

}  // namespace

void Viewer::toggle_panel() {
  panel_ = !panel_;
  show_panels();
  panel_opened_ = panel_;
  const GlobeOptions& options = globe_.options();
  settings_.has_sky = options.sky;
  settings_.has_relief = globe_.has_relief();
  settings_.exaggeration = options.exaggeration;
}

// Reads the globe's settings first, because keys may have changed them.
void Viewer::draw_settings() {
  const GlobeOptions& options = globe_.options();
  settings_.surface = options.surface;
  settings_.stereo = options.stereo;
  settings_.sky = sky_;
  settings_.under_ground = under_ground();
  const std::optional<UtcTime> time = settings_.time = options.time;
  const ViewAsk ask = draw_view_settings(settings_, std::exchange(panel_opened_, false));
  if (ask == ViewAsk::layers) toggle_layers();
  if (ask == ViewAsk::picture) toggle_picture_panel();
  if (ask == ViewAsk::help) help_ = !help_;
  // Setting a value draws a frame, so unchanged values are not set.
  if (settings_.surface != options.surface) globe_.set_surface(settings_.surface);
  if (settings_.stereo != options.stereo) globe_.set_stereo(settings_.stereo);
  if (settings_.sky != sky_) globe_.set_sky(sky_ = settings_.sky);
  if (settings_.under_ground != under_ground()) toggle_underground();
  if (settings_.exaggeration != options.exaggeration) globe_.set_exaggeration(settings_.exaggeration);
  if (settings_.time == time) return;
  const Status set = globe_.set_time(settings_.time);
  settings_.time_problem = set ? "" : set.error().message;
}

void Viewer::show_panels() {
  ui_.take_events(any_panel());
  panel_frames_ = kPanelFrames;
}

// Gives the keyboard to the panel on top. Its text field is ready for typing.
void Viewer::pass_keyboard() {
  const bool to_search = searching_ && !picture_panel_shown_ && !Ui::panel_has_keyboard();
  const char* beside = panel_ ? kViewTitle : kLayersTitle;
  Ui::pass_keyboard(picture_panel_shown_ ? kPictureTitle : searching_ ? kSearchTitle : beside);
  if (to_search) search_.just_opened = true;
  ui_.expect_text(to_search);
  show_panels();
}

bool Viewer::any_panel() const { return panel_ || searching_ || layers_shown_ || picture_panel_shown_; }

void Viewer::toggle_picture_panel() {
  picture_panel_shown_ = !picture_panel_shown_;
  picture_panel_.just_opened = picture_panel_shown_;
  show_panels();
}

void Viewer::draw_picture_panel() {
  const PictureAsk ask = terrella::draw_picture_panel(picture_panel_, window_.framebuffer(), largest_picture_side_px());
  if (ask == PictureAsk::none) return;
  toggle_picture_panel();
  if (ask == PictureAsk::save) start_picture({picture_panel_.width_px, picture_panel_.height_px});
}

void Viewer::start_picture(Viewport size) {
  std::error_code unknown;
  const auto file = screenshot_name(std::filesystem::current_path(unknown), std::chrono::system_clock::now());
  auto job = PictureJob::start(globe_, file, size);
  if (!job) return say(job.error().message);
  picture_job_ = *std::move(job);
}

// The globe was drawn at another size since.
void Viewer::end_picture(std::string message) {
  picture_job_.reset();
  picture_.reset();
  say(std::move(message));
}

void Viewer::draw_picture(Viewport framebuffer) {
  globe_.set_camera(navigator_.camera());
  picture_job_->draw(globe_, framebuffer);
  const auto result = picture_job_->result();
  if (!result) return;
  const std::string name = picture_job_->file().filename().string();
  end_picture(*result ? "Saved " + name : result->error().message);
}

// Each eye gets its own lines; interlaced pictures have too few rows for two sets.
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

}  // namespace terrella
