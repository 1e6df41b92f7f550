#include "apps/viewer/viewer.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/setup/data_dir.h"

namespace terrella {
namespace {

constexpr double kPlaceHeight = 0.05;  // height above a found place, in radii

// Loads the list of places; without the list the globe still works.
Gazetteer load_places() {
  try {
    Result<Gazetteer> places = Gazetteer::load(data_file("populated_places_110m.geojson"));
    if (places) return *std::move(places);
  } catch (const BrokenInstallation&) {
  }
  return {};
}

}  // namespace

// Ends or starts measuring; ending removes the measurement.
void Viewer::toggle_measuring() {
  measuring_ = !measuring_;
  input_.set_double_clicks(!measuring_);
  measure_.clear();
  draw_measure();
}

void Viewer::measure_at(glm::dvec2 px) {
  auto place = pick(globe_.view(window_.framebuffer()), globe_.ground(), px);
  if (!place) return say("There is no ground to measure from");
  if (!globe_.has_relief()) place->height_m = 0.0;  // rounding could put the place under the ground
  measure_.add(*place);
  draw_measure();
}

void Viewer::draw_measure() {
  ObjectScene scene = measure_.scene(globe_.options().body.ellipsoid, window_.text_scale());
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

// Reads the file each time, because another window may have set a bookmark. A damaged file is left unchanged.
void Viewer::use(const BookmarkKey& key) {
  const auto file = bookmarks_file();
  if (file) {
    Result<Bookmarks> kept = Bookmarks::load(*file);
    if (!kept) return say(kept.error().message);
    bookmarks_ = *std::move(kept);
  }
  const std::optional<Camera>& there = bookmarks_.at(key.number);
  if (!key.set && !there) return say(fmt::format("Bookmark {0} is empty; Ctrl + {0} saves the view", key.number));
  if (!key.set) return navigator_.fly_to(*there, Input::now());
  bookmarks_.set(key.number, navigator_.camera());
  const Status saved = file ? bookmarks_.save(*file) : Status(Error{"Kept until the window closes: HOME is not set"});
  say(saved ? fmt::format("Bookmark {} saved", key.number) : saved.error().message);
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
  show_panels();
}

void Viewer::draw_search() {
  const auto chosen = draw_place_search(search_, places());
  if (search_.has_keyboard) ui_.field_is_ready();
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

}  // namespace terrella
