#include <fmt/core.h>

#include <memory>
#include <string>
#include <utility>

#include "apps/commands.h"
#include "apps/open_imagery.h"
#include "apps/scene_layers.h"
#include "apps/scene_objects.h"
#include "apps/scene_options.h"
#include "apps/scene_overlays.h"
#include "apps/viewer/viewer.h"

namespace terrella {
namespace {

constexpr Viewport kWindow{.width_px = 1280, .height_px = 800};

constexpr const char* kHelpFooter =
    "In the window: drag holds the ground, the wheel zooms to the cursor, right drag or Ctrl + drag tilts and turns,\n"
    "a double click flies there; arrows, + and - move; N north up, Home whole globe, G graticule, F full screen,\n"
    "/ finds a place, M measures, U translucent, X under the ground, B sky, S stereo, P a panel with all of that, F12 "
    "saves a picture,\n"
    "F1 or ? lists the keys, Esc leaves.\n"
    "\n"
    "Examples:\n"
    "  terrella view                                      the Earth\n"
    "  terrella view moon.jpg --body moon                 a picture of the whole Moon\n"
    "  terrella view earth.gpkg --camera 46,7,3e5,30,-20  the Alps from the south west";

struct ViewOptions {
  SceneOptions scene;
  bool print_camera = false;
  bool full_screen = false;
};

int view(const ViewOptions& options) {
  if (const Status found = find_imagery(options.scene); !found) return fail("view", found.error().message);
  // The window comes before the cutting: without a display nobody should wait for a picture to be cut.
  auto window = Window::create("Terrella", options.scene.size);
  if (!window) return fail("view", window.error().message);
  auto imagery = open_imagery(options.scene);
  if (!imagery) return fail("view", imagery.error().message);
  auto elevation = open_elevation(options.scene);
  if (!elevation) return fail("view", elevation.error().message);
  const auto body = scene_body(options.scene, (*imagery)->info());
  if (!body) return fail("view", body.error().message);
  GlobeOptions globe_options_with_sky = globe_options(options.scene, *body);
  add_sky_data(globe_options_with_sky);
  add_label_font(globe_options_with_sky);
  auto globe = Globe::create(globe_options_with_sky, std::move(*imagery), *std::move(elevation));
  if (!globe) return fail("view", globe.error().message);
  if (const Status overlaid = add_overlays(**globe, options.scene); !overlaid)
    return fail("view", overlaid.error().message);
  if (const Status layers = add_image_layers(**globe, options.scene); !layers)
    return fail("view", layers.error().message);
  if (const Result<bool> added = add_objects(**globe, options.scene); !added)
    return fail("view", added.error().message);
  (*window)->show();
  if (options.full_screen) (*window)->toggle_full_screen();
  const ViewerOptions viewer_options{.camera = first_camera(options.scene, *body, (*window)->framebuffer()),
                                     .print_camera = options.print_camera};
  Viewer(**window, **globe, viewer_options).run();
  return kDone;
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("view", "Turn a globe in a window");
  const auto options = std::make_shared<ViewOptions>();
  options->scene.size = kWindow;
  add_scene_options(*command, options->scene);
  command->get_option("--size")->default_str(fmt::format("{}x{}", kWindow.width_px, kWindow.height_px));
  command->add_flag("--print-camera", options->print_camera,
                    "Print the camera, as --camera takes it, on standard output each time it comes to rest");
  command->add_flag("--fullscreen", options->full_screen, "Fill the screen; F goes back to a window");
  command->footer(kHelpFooter);
  command->callback([options, &exit_code] { exit_code = view(*options); });
}

}  // namespace terrella
