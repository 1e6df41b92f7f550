#include <algorithm>
#include <iterator>
#include <utility>

#include "apps/open_scene/project/project_paths.h"
#include "apps/viewer/viewer.h"
#include "streaming/georeference/figure.h"

namespace terrella {

KeptSettings Viewer::now_kept() {
  const Viewport size = window_.windowed();
  return {.width_px = size.width_px,
          .height_px = size.height_px,
          .panel = modes_.is_open(),
          .layers = layers_.is_open(),
          .graticule = graticule_.is_on(),
          .map = map_.is_on(),
          .restore = projects_.restores(),
          .units = ui_.units()};
}

SceneOptions Viewer::scene() const {
  const GlobeOptions& globe = globe_.options();
  SceneOptions now = options_.scene;
  now.base.body = globe.body;
  now.camera = nameable(navigator_.camera());
  now.size = window_.framebuffer();
  now.exaggeration = globe.exaggeration;
  now.surface = globe.surface;
  now.stereo = globe.stereo;
  now.sky = modes_.has_sky();
  now.time = globe.time;
  now.night_lights = !globe.time || globe_.has_night_lights();
  now.graticule = graticule_.is_on();
  if (map_.exists()) now.map = map_.is_on();
  // The rows of the layers have what the command line named.
  now.overlays.clear();
  now.night = {};
  now.clouds = {};
  now.objects.clear();
  layers_.describe(now);
  now.drawings.clear();
  flights_.put_back(now);
  return now;
}

// A project replaces the scene; any other file becomes a layer, and its tours become flights.
void Viewer::open_file(const std::filesystem::path& file) {
  if (is_project(file.string())) return projects_.open(file);
  layers_.open({.address = file.string()});
  flights_.look_into(file, true);
}

// False, with a message, if drawings, a film or files that are being opened would be lost.
bool Viewer::may_leave() {
  panel_frames_ = kPanelFrames;  // shows the message
  if (!draw_.may_quit() || !flights_.may_quit()) return false;
  if (layers_.job().empty()) return true;
  messages_.say("A file is still being opened. Wait for it, or leave it out with Esc.");
  return false;
}

// Files that are not open yet go along with those that the user sends to the body.
bool Viewer::open_on_globe(const Body& body, std::vector<SourceOptions> files) {
  if (!draw_.may_quit() || !flights_.may_quit()) return false;
  std::ranges::move(layers_.leave_off(), std::back_inserter(files));
  projects_.leave_for({.body = body, .layers = std::move(files)});
  return true;
}

// Data of another body go to the globe of that body.
void Viewer::add_data(const CatalogueEntry& entry) {
  if (!are_two_bodies(entry.body, globe_.options().body)) return layers_.open(entry.said);
  if (may_leave()) projects_.leave_for({.body = entry.body, .layers = {entry.said}});
}

std::vector<LayerSwitch> Viewer::switches() {
  std::vector<LayerSwitch> switches{{"Graticule", "G: lines of latitude and longitude.", graticule_.is_on()}};
  if (map_.exists()) switches.push_back({"Map", "C: coastlines, borders and names.", map_.is_on()});
  return switches;
}

// Saves the settings. A failure is reported once, because the settings then count as saved.
void Viewer::keep_settings() {
  const KeptSettings now = changed_since(options_.kept, started_, now_kept());
  if (now == saved_) return;
  saved_ = now;
  const auto file = settings_file();
  if (!file) return;
  if (const Status saved = save_settings(*file, now); !saved) messages_.say(saved.error());
}

}  // namespace terrella
