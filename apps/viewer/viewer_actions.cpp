#include "apps/viewer/viewer.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace terrella {
namespace {

constexpr double kEarthEquator_m = 6378137.0;

}  // namespace

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
      say(sky_ ? "Sky on" : "Sky off");
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
    case ViewerAction::toggle_layers:
      return toggle_layers();
    case ViewerAction::picture:
      return toggle_picture_panel();
    case ViewerAction::panel_focus:
      return pass_keyboard();
    case ViewerAction::find_place:
      return toggle_search();
    case ViewerAction::leave:
      if (leave_something()) return;
      glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE);
      return;
  }
}

// Esc ends one mode or panel at a time; returns false if none was active.
bool Viewer::leave_something() {
  if (picture_job_ && !picture_job_->drawn()) {
    end_picture("Picture cancelled");
  } else if (dropped_.busy()) {
    dropped_.leave_off();
  } else if (help_) {
    help_ = false;
  } else if (picture_panel_shown_) {
    toggle_picture_panel();
  } else if (searching_) {
    toggle_search();
  } else if (layers_shown_) {
    toggle_layers();
  } else if (panel_) {
    toggle_panel();
  } else if (measuring_) {
    toggle_measuring();
  } else {
    return false;
  }
  return true;
}

void Viewer::next_alpha() {
  constexpr double kAlphas[] = {1.0, 0.7, 0.4};
  SurfaceLook surface = globe_.options().surface;
  const auto* lower =
      std::find_if(std::begin(kAlphas), std::end(kAlphas), [&](double alpha) { return alpha < surface.alpha - 0.01; });
  surface.alpha = lower == std::end(kAlphas) ? kAlphas[0] : *lower;
  globe_.set_surface(surface);
  say(fmt::format("Opacity {:.0f} %", 100.0 * surface.alpha));
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

// True if the eye is under the ground now; the eye may have flown up since X was pressed.
bool Viewer::under_ground() const {
  const Geodetic eye = navigator_.camera().eye;
  return eye.height_m < globe_.ground_height_m(eye.lat, eye.lon);
}

// Moves the eye under its place, as deep as it was high but above the inner sphere, looking up at the ground.
void Viewer::toggle_underground() {
  Camera camera = navigator_.camera();
  const double ground_m = globe_.ground_height_m(camera.eye.lat, camera.eye.lon);
  if (under_ground()) {
    camera.eye.height_m = 2.0 * ground_m - camera.eye.height_m;
    camera.pitch = Angle::degrees(-90.0);
    if (above_) camera = *std::exchange(above_, std::nullopt);
    navigator_.set_deepest({});
    say("Above the ground");
  } else {
    above_ = camera;
    navigator_.set_deepest(deepest_m());
    camera.eye.height_m = std::max(2.0 * ground_m - camera.eye.height_m, deepest_m());
    camera.pitch = Angle::degrees(std::max(30.0, -camera.pitch.deg()));
    say("Under the ground; X returns");
  }
  navigator_.set_camera(camera);
}

}  // namespace terrella
