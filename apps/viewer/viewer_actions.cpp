#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>

#include "apps/viewer/viewer.h"

namespace terrella {
namespace {

constexpr double kTurnStep_px = 24.0;  // at 96 dots per inch: drag distance that an arrow with Shift stands for
constexpr unsigned kHeld = Action::repeats, kTilts = Action::repeats | Action::shifted;
using Go = NavigationKey;
using V = Viewer&;

}  // namespace

template <NavigationKey kKey>
void Viewer::navigate(Viewer& viewer) {
  viewer.navigator_.key(kKey, Input::now());
}

// Acts like a right drag around the picture's middle. Ignored while a button is held.
template <int kRight, int kDown>
void Viewer::turn(Viewer& viewer) {
  if (viewer.input_.is_button_held()) return;
  const glm::dvec2 middle = viewer.context_.middle_px();
  const glm::dvec2 by_px = kTurnStep_px * viewer.window_.text_scale() * glm::dvec2(kRight, kDown);
  viewer.navigator_.pointer_down(PointerButton::right, false, middle, Input::now());
  viewer.navigator_.pointer_move(middle + by_px, Input::now());
  viewer.navigator_.pointer_up(PointerButton::right, Input::now());
}

// Esc cancels a job, or else closes a panel or ends a tool, or else quits.
void Viewer::leave() {
  for (Part* part : parts_) {
    if (part->cancel()) return;
  }
  for (Part* part : parts_) {
    if (part->close()) return;
  }
  glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE);
}

// Gives the keyboard to the panel on top, or back to the globe.
void Viewer::pass_keyboard() {
  Part* front = front_panel();
  if (front == nullptr) return;
  const bool to_panel = !Ui::panel_has_keyboard();
  Ui::pass_keyboard(front->panel());
  to_panel ? front->take_keyboard() : ui_.expect_text(false);
  panel_frames_ = kPanelFrames;
}

constinit const Action Viewer::kActions[] = {
    {"Drag", "move the ground"},
    {"Wheel", "zoom to the cursor"},
    {"Right-drag, Ctrl + drag", "tilt and turn"},
    {"Double-click", "fly to this place"},
    {"Arrows; with Shift", "move; tilt and turn", turn<1, 0>, U"", GLFW_KEY_LEFT, 0, kTilts},
    {nullptr, nullptr, turn<-1, 0>, U"", GLFW_KEY_RIGHT, 0, kTilts},
    {nullptr, nullptr, turn<0, -1>, U"", GLFW_KEY_UP, 0, kTilts},
    {nullptr, nullptr, turn<0, 1>, U"", GLFW_KEY_DOWN, 0, kTilts},
    {nullptr, nullptr, navigate<Go::pan_left>, U"", GLFW_KEY_LEFT, 0, kHeld},
    {nullptr, nullptr, navigate<Go::pan_right>, U"", GLFW_KEY_RIGHT, 0, kHeld},
    {nullptr, nullptr, navigate<Go::pan_up>, U"", GLFW_KEY_UP, 0, kHeld},
    {nullptr, nullptr, navigate<Go::pan_down>, U"", GLFW_KEY_DOWN, 0, kHeld},
    {"+  -  Page up, down", "zoom", navigate<Go::zoom_in>, U"+=", GLFW_KEY_PAGE_UP, 0, kHeld},
    {nullptr, nullptr, navigate<Go::zoom_out>, U"-\u2212", GLFW_KEY_PAGE_DOWN, 0, kHeld},
    {"N", "north up", navigate<Go::north_up>, U"n"},
    {"Home", "the whole globe", navigate<Go::whole_globe>, U"", GLFW_KEY_HOME, 0, kHeld},
    {"R", "reset the view: look of the start, whole globe", [](V v) { v.modes_.reset(); }, U"r", 0, 0, 0, "Reset"},
    {"G", "graticule", [](V v) { v.graticule_.is_on() = !v.graticule_.is_on(); }, U"g"},
    {"C", "map: coastlines, borders and names", [](V v) { v.map_.toggle(); }, U"c"},
    {"/", "search for a place", [](V v) { v.search_.toggle(); }, U"/", 0, 0, Action::types},
    {"M", "measure: click to add, Enter for the centre, Backspace to undo", [](V v) { v.measure_.toggle(); }, U"m"},
    {nullptr, nullptr, [](V v) { v.measure_.add(v.context_.middle_px()); }, U"", GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER},
    {nullptr, nullptr, [](V v) { v.measure_.take_back(); }, U"", GLFW_KEY_BACKSPACE},
    {"1 ... 9", "fly to a bookmark; Ctrl saves the view"},
    {"P", "view settings", [](V v) { v.modes_.toggle(); }, U"p"},
    {"L", "layers: show, opacity, order, remove", [](V v) { v.layers_.toggle(); }, U"l", 0, 0, 0, "Layers"},
    {"Drop a file", "add a picture, tile set, GeoJSON or glTF"},
    {"U", "translucent surface", [](V v) { v.modes_.next_opacity(); }, U"u"},
    {"X", "go under the ground, and back", [](V v) { v.modes_.toggle_underground(); }, U"x"},
    {"B", "sky on or off", [](V v) { v.modes_.toggle_sky(); }, U"b"},
    {"S", "stereo: anaglyph, side by side, interlaced, off", [](V v) { v.modes_.next_stereo(); }, U"s"},
    {"F", "full screen", [](V v) { v.window_.toggle_full_screen(); }, U"f"},
    {"I", "save a picture of any size", [](V v) { v.pictures_.toggle(); }, U"i", 0, 0, 0, "Picture"},
    {"F12", "save a screenshot", [](V v) { v.pictures_.want_screenshot(); }, U"", GLFW_KEY_F12},
    {"F6", "switch the keyboard between panel and globe", [](V v) { v.pass_keyboard(); }, U"", GLFW_KEY_F6},
    {"F1  ?", "shortcuts", [](V v) { v.help_.toggle(); }, U"?", GLFW_KEY_F1, 0, 0, "Shortcuts"},
    {"Esc", "close a panel, cancel, quit", [](V v) { v.leave(); }, U"", GLFW_KEY_ESCAPE},
};

std::span<const Action> Viewer::actions() { return kActions; }

}  // namespace terrella
