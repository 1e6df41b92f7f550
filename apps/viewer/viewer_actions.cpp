#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>

#include <cmath>
#include <utility>

#include "apps/viewer/viewer.h"

namespace terrella {
namespace {

constexpr double kTurnStep_px = 24.0;         // at 96 dots per inch: drag distance that an arrow with Shift stands for
constexpr std::chrono::seconds kQuitTime(3);  // for the second Esc
constexpr Seconds kDoubleTurn(1.0);           // for the second click on the compass
constexpr double kNorth_deg = 0.5;
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

// Esc closes a list of choices, which Dear ImGui does; or cancels a job, closes a fault or a panel, ends a tool or
// removes the mark of a search. With none of them, a second Esc quits.
void Viewer::leave() {
  if (Ui::has_open_list()) return;
  const bool again = Clock::now() < std::exchange(quit_until_, Clock::time_point());
  for (Part* part : parts_) {
    if (part->cancel()) return;
  }
  if (messages_.close_fault()) return;
  for (Part* part : parts_) {
    if (part->close()) return;
  }
  if (search_.remove_mark()) return;
  if (again) return quit();
  quit_until_ = Clock::now() + kQuitTime;
  messages_.say("Press Esc again to quit", kQuitTime);
}

void Viewer::add_middle() {
  draw_.is_sketching() ? draw_.add(context_.middle_px()) : measure_.add(context_.middle_px());
}

void Viewer::take_back() { draw_.is_sketching() ? draw_.take_back() : measure_.take_back(); }

void Viewer::undo() { draw_.is_open() ? draw_.undo() : layers_.undo(); }

void Viewer::redo() { draw_.is_open() ? draw_.redo() : layers_.redo(); }

void Viewer::save_drawn() { draw_.is_open() && !measure_.is_on() ? draw_.save() : measure_.save(); }

void Viewer::toggle_swipe() {
  if (!swipe_.is_on() && !layers_.choose_swipe_sides())
    return messages_.say("A swipe compares image layers, and only one is shown. Ctrl + O adds another one.");
  swipe_.show(!swipe_.is_on());
  messages_.say(swipe_.is_on() ? "Swipe on: drag the line; L chooses the side of each layer" : "Swipe off");
}

void Viewer::click(glm::dvec2 at_px) {
  if (draw_.click(at_px)) return;
  measure_.is_on() ? measure_.add(at_px) : balloon_.click(at_px);
}

void Viewer::quit() { glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE); }

// Drawings that cannot be kept, and films, are told of before they are lost.
bool Viewer::is_closed() {
  if (glfwWindowShouldClose(window_.handle()) == GLFW_FALSE && !projects_.next()) return false;
  if (draw_.may_quit() && flights_.may_quit()) return true;
  glfwSetWindowShouldClose(window_.handle(), GLFW_FALSE);
  projects_.stay();
  panel_frames_ = kPanelFrames;  // shows the message
  return false;
}

// The compass: the first click turns north up, a second click also looks straight down.
void Viewer::turn_back() {
  const bool again = Input::now() - std::exchange(turned_back_, Input::now()) < kDoubleTurn;
  const bool has_north_up = std::abs(std::remainder(navigator_.camera().heading.deg(), 360.0)) < kNorth_deg;
  navigator_.key(again || has_north_up ? Go::look_down : Go::north_up, Input::now());
}

void Viewer::travel(const std::optional<Camera>& to, const char* nowhere) {
  to ? navigator_.fly_to(*to, Input::now()) : messages_.say(nowhere);
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
    {.keys = "Arrows", .what = "move the ground", .mouse = "drag"},
    {nullptr, nullptr, navigate<Go::pan_left>, U"", GLFW_KEY_LEFT, 0, kHeld},
    {nullptr, nullptr, navigate<Go::pan_right>, U"", GLFW_KEY_RIGHT, 0, kHeld},
    {nullptr, nullptr, navigate<Go::pan_up>, U"", GLFW_KEY_UP, 0, kHeld},
    {nullptr, nullptr, navigate<Go::pan_down>, U"", GLFW_KEY_DOWN, 0, kHeld},
    {.keys = "+  Page up",
     .what = "zoom in",
     .run = navigate<Go::zoom_in>,
     .characters = U"+=",
     .key = GLFW_KEY_PAGE_UP,
     .flags = kHeld,
     .mouse = "wheel, button",
     .icon = Icon::plus},
    {.keys = "-  Page down",
     .what = "zoom out",
     .run = navigate<Go::zoom_out>,
     .characters = U"-\u2212",
     .key = GLFW_KEY_PAGE_DOWN,
     .flags = kHeld,
     .mouse = "wheel, button",
     .icon = Icon::minus},
    {.keys = "Shift + Left, Right", .what = "turn", .mouse = "right drag, Ctrl + drag"},
    {nullptr, nullptr, turn<1, 0>, U"", GLFW_KEY_LEFT, 0, kTilts},
    {nullptr, nullptr, turn<-1, 0>, U"", GLFW_KEY_RIGHT, 0, kTilts},
    {.keys = "Shift + Up",
     .what = "tilt towards the horizon",
     .run = turn<0, -1>,
     .key = GLFW_KEY_UP,
     .flags = kTilts,
     .mouse = "right drag, button",
     .icon = Icon::tilted},
    {.keys = "Shift + Down",
     .what = "tilt towards straight down",
     .run = turn<0, 1>,
     .key = GLFW_KEY_DOWN,
     .flags = kTilts,
     .mouse = "right drag, button",
     .icon = Icon::flat},
    {.keys = "N",
     .what = "north up; again: look straight down",
     .run = [](V v) { v.turn_back(); },
     .characters = U"n",
     .flags = Action::unlisted,
     .mouse = "compass",
     .icon = Icon::compass},
    {.keys = "Home",
     .what = "the whole globe",
     .run = navigate<Go::whole_globe>,
     .key = GLFW_KEY_HOME,
     .flags = kHeld,
     .mouse = "button",
     .icon = Icon::home},
    {.keys = "Alt + Left",
     .what = "back to the view before",
     .run = [](V v) { v.travel(v.history_.back(), "There is no earlier view"); },
     .key = GLFW_KEY_LEFT,
     .flags = Action::alted | Action::unlisted,
     .mouse = "button, mouse button 4",
     .icon = Icon::back,
     .mouse_button = GLFW_MOUSE_BUTTON_4},
    {.keys = "Alt + Right",
     .what = "forward to the next view",
     .run = [](V v) { v.travel(v.history_.forward(), "There is no later view"); },
     .key = GLFW_KEY_RIGHT,
     .flags = Action::alted | Action::unlisted,
     .mouse = "button, mouse button 5",
     .icon = Icon::forward,
     .mouse_button = GLFW_MOUSE_BUTTON_5},
    {.keys = "Menu, Shift + F10",
     .what = "menu of the place: copy, measure, centre, fly there",
     .run = [](V v) { v.menu_.open_at(v.context_.middle_px()); },
     .key = GLFW_KEY_MENU,
     .flags = Action::unlisted,
     .mouse = "right click, button",
     .icon = Icon::menu},
    {nullptr, nullptr, [](V v) { v.menu_.open_at(v.context_.middle_px()); }, U"", GLFW_KEY_F10, 0, Action::shifted},
    {.keys = "O",
     .what = "object in the middle of the view: show its fields",
     .run = [](V v) { v.balloon_.open_in_middle(); },
     .characters = U"o",
     .flags = Action::unlisted,
     .mouse = "click an object"},
    {.keys = "menu", .what = "fly to a place", .mouse = "double click, menu"},
    {"R", "reset the view: settings as at the start, whole globe", [](V v) { v.modes_.reset(); }, U"r", 0, 0, 0,
     "Reset"},
    {"G", "graticule", [](V v) { v.graticule_.is_on() = !v.graticule_.is_on(); }, U"g"},
    {"C", "map: coastlines, borders and names", [](V v) { v.map_.toggle(); }, U"c"},
    {.keys = "/",
     .what = "search for a place",
     .run = [](V v) { v.search_.toggle(); },
     .characters = U"/",
     .flags = Action::types,
     .mouse = "menu, button",
     .icon = Icon::search},
    {"M", "measure: start, end", [](V v) { v.measure_.toggle(); }, U"m"},
    {"D", "draw: place marks, lines, areas", [](V v) { v.draw_.toggle(); }, U"d"},
    {.keys = "Enter",
     .what = "measure, draw: add the middle of the view",
     .run = [](V v) { v.add_middle(); },
     .key = GLFW_KEY_ENTER,
     .other_key = GLFW_KEY_KP_ENTER,
     .flags = Action::unlisted,
     .mouse = "click a place"},
    {.keys = "Backspace",
     .what = "measure, draw: remove the last place",
     .run = [](V v) { v.take_back(); },
     .key = GLFW_KEY_BACKSPACE,
     .flags = Action::unlisted,
     .mouse = "Undo"},
    {.keys = "Ctrl + C",
     .what = "measure: copy the result",
     .run = [](V v) { v.measure_.copy(); },
     .characters = U"c",
     .flags = Action::ctrl | Action::unlisted,
     .mouse = "Copy"},
    {.keys = "Ctrl + D",
     .what = "measure: keep the result as a drawing",
     .run = [](V v) { v.measure_.keep(); },
     .characters = U"d",
     .flags = Action::ctrl | Action::unlisted,
     .mouse = "Keep"},
    {.keys = "Ctrl + P",
     .what = "measure: profile of heights and numbers",
     .run = [](V v) { v.profile_.toggle(); },
     .characters = U"p",
     .flags = Action::ctrl | Action::unlisted,
     .mouse = "Profile"},
    {.keys = "Ctrl + S",
     .what = "measure, draw: save as GeoJSON or KML",
     .run = [](V v) { v.save_drawn(); },
     .characters = U"s",
     .flags = Action::ctrl | Action::unlisted,
     .mouse = "Save"},
    {.keys = "Ctrl + Z",
     .what = "undo: drawing while it is open, else layers",
     .run = [](V v) { v.undo(); },
     .characters = U"z",
     .flags = Action::ctrl | Action::unlisted,
     .mouse = "Undo"},
    {.keys = "Ctrl + Y, Ctrl + Shift + Z",
     .what = "redo: drawing while it is open, else layers",
     .run = [](V v) { v.redo(); },
     .characters = U"y",
     .flags = Action::ctrl | Action::unlisted,
     .mouse = "Redo"},
    {nullptr, nullptr, [](V v) { v.redo(); }, U"z", 0, 0, Action::ctrl | Action::shifted},
    {"K", "bookmarks: fly, name, sort, delete", [](V v) { v.bookmarks_.toggle(); }, U"k"},
    {.keys = "1 ... 9", .what = "fly to a bookmark", .mouse = "bookmarks"},
    {.keys = "Ctrl + 1 ... 9", .what = "save the view as a bookmark", .mouse = "menu"},
    {"Y", "flight: bookmarks and tours, film", [](V v) { v.flights_.toggle(); }, U"y"},
    {"P", "view settings", [](V v) { v.modes_.toggle(); }, U"p"},
    {.keys = "L",
     .what = "layers: show, opacity, order, remove",
     .run = [](V v) { v.layers_.toggle(); },
     .characters = U"l",
     .button = "Layers",
     .mouse = "menu, button",
     .icon = Icon::layers},
    {.keys = "Ctrl + O",
     .what = "open a file, folder or address",
     .run = [](V v) { v.open_.toggle(); },
     .characters = U"o",
     .flags = Action::ctrl | Action::types,
     .button = "Open",
     .mouse = "menu, drop a file"},
    {"J", "project: save, restore at the next start, new", [](V v) { v.projects_.toggle(); }, U"j", 0, 0,
     Action::types},
    {"E", "add data: public pictures by body and theme", [](V v) { v.catalogue_.toggle(); }, U"e", 0, 0, Action::types},
    {"W", "body: Earth, Moon, planets", [](V v) { v.body_.toggle(); }, U"w"},
    {"A", "dates of layers: play, step", [](V v) { v.timeline_.toggle(); }, U"a"},
    {"V", "swipe: compare layers at a line", [](V v) { v.toggle_swipe(); }, U"v"},
    {"U", "translucent surface", [](V v) { v.modes_.next_opacity(); }, U"u"},
    {"X", "go under the ground, and back", [](V v) { v.modes_.toggle_underground(); }, U"x"},
    {"B", "sky on or off", [](V v) { v.modes_.toggle_sky(); }, U"b"},
    {.keys = "T",
     .what = "play or pause the time",
     .run = [](V v) { v.modes_.toggle_play(); },
     .characters = U"t",
     .mouse = "menu, button",
     .icon = Icon::clock},
    {"S", "stereo: anaglyph, side by side, interlaced, off", [](V v) { v.modes_.next_stereo(); }, U"s"},
    {"F", "full screen", [](V v) { v.window_.toggle_full_screen(); }, U"f"},
    {"I", "save a picture of any size", [](V v) { v.pictures_.toggle(); }, U"i", 0, 0, 0, "Picture"},
    {"F12", "save a screenshot", [](V v) { v.pictures_.want_screenshot(); }, U"", GLFW_KEY_F12},
    {"F3", "frame time, tiles, memory", [](V v) { v.frame_graph_.toggle(); }, U"", GLFW_KEY_F3},
    {.keys = "F6",
     .what = "switch the keyboard between panel and globe",
     .run = [](V v) { v.pass_keyboard(); },
     .key = GLFW_KEY_F6,
     .flags = Action::unlisted | Action::passes,
     .mouse = "click the panel or the globe"},
    {"F1  ?", "shortcuts", [](V v) { v.help_.toggle(); }, U"?", GLFW_KEY_F1, 0, 0, "Shortcuts"},
    {.keys = "Esc",
     .what = "close a panel, cancel; twice: quit",
     .run = [](V v) { v.leave(); },
     .key = GLFW_KEY_ESCAPE,
     .flags = Action::unlisted,
     .mouse = "cross of the panel"},
    {.keys = "Ctrl + Q", .what = "quit", .run = [](V v) { v.quit(); }, .characters = U"q", .flags = Action::ctrl},
};

std::span<const Action> Viewer::actions() { return kActions; }

}  // namespace terrella
