#include "apps/viewer/input.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>

#include <glm/geometric.hpp>
#include <utility>

namespace terrella {
namespace {

constexpr Seconds kDoubleClick(0.4);
constexpr double kTurnStep_px = 24.0;   // at 96 dots per inch: drag distance that an arrow with Shift stands for
constexpr double kClickSlack_px = 6.0;  // at 96 dots per inch

Input& input_of(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

std::optional<NavigationKey> navigation_key(int key) {
  switch (key) {
    case GLFW_KEY_LEFT:
      return NavigationKey::pan_left;
    case GLFW_KEY_RIGHT:
      return NavigationKey::pan_right;
    case GLFW_KEY_UP:
      return NavigationKey::pan_up;
    case GLFW_KEY_DOWN:
      return NavigationKey::pan_down;
    case GLFW_KEY_PAGE_UP:
      return NavigationKey::zoom_in;
    case GLFW_KEY_PAGE_DOWN:
      return NavigationKey::zoom_out;
    case GLFW_KEY_HOME:
      return NavigationKey::whole_globe;
    default:
      return {};
  }
}

std::optional<ViewerAction> function_key(int key) {
  switch (key) {
    case GLFW_KEY_F1:
      return ViewerAction::toggle_help;
    case GLFW_KEY_F6:
      return ViewerAction::panel_focus;
    case GLFW_KEY_F12:
      return ViewerAction::save_screenshot;
    case GLFW_KEY_ESCAPE:
      return ViewerAction::leave;
    default:
      return {};
  }
}

std::optional<ViewerAction> measuring_key(int key) {
  switch (key) {
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return ViewerAction::measure_middle;
    case GLFW_KEY_BACKSPACE:
      return ViewerAction::take_back;
    default:
      return {};
  }
}

}  // namespace

bool ClickPair::press(glm::dvec2 at_px, Seconds now, double slack_px) {
  const bool second = first_ && now - first_->when >= Seconds(0.0) && now - first_->when <= kDoubleClick &&
                      glm::distance(at_px, first_->at_px) <= slack_px;
  if (second) {
    first_.reset();
  } else {
    first_ = Press{at_px, now};
  }
  return second;
}

Input::Input(Window& window, Ui& ui, Navigator& navigator)
    : window_(window), ui_(ui), navigator_(navigator), pointer_px_(window.cursor_px()), heard_until_(now()) {
  glfwSetWindowUserPointer(window_.handle(), this);
  listen_to_pointer();
  listen_to_keys();
  listen_to_window();
}

Seconds Input::now() { return Seconds(glfwGetTime()); }

// GLFW events have no time. Events that arrived during a frame may be as old as that frame.
void Input::listen(std::optional<double> wait_s) {
  late_ = now() - heard_until_;
  if (wait_s) {
    glfwWaitEventsTimeout(*wait_s);
  } else {
    glfwPollEvents();
  }
  heard_until_ = now();
}

std::vector<ViewerAction> Input::take_actions() { return std::exchange(actions_, {}); }

std::vector<glm::dvec2> Input::take_clicks() { return std::exchange(clicks_px_, {}); }

std::vector<std::filesystem::path> Input::take_dropped() { return std::exchange(dropped_, {}); }

std::optional<BookmarkKey> Input::take_bookmark() { return std::exchange(bookmark_, {}); }

bool Input::take_dirty() { return std::exchange(dirty_, false); }

std::optional<glm::dvec2> Input::cursor_px() const {
  if (glfwGetWindowAttrib(window_.handle(), GLFW_HOVERED) != GLFW_TRUE) return {};
  return pointer_px_;
}

void Input::listen_to_pointer() {
  glfwSetMouseButtonCallback(window_.handle(), [](GLFWwindow* w, int button, int action, int modifiers) {
    input_of(w).dirty_ = true;
    if (!Ui::on_button(w, button, action, modifiers) || action == GLFW_RELEASE) {
      input_of(w).on_button(button, action, modifiers);
    }
  });
  glfwSetCursorPosCallback(window_.handle(), [](GLFWwindow* w, double x, double y) {
    Input& self = input_of(w);
    self.pointer_px_ = self.window_.to_px({x, y});
    self.navigator_.pointer_move(self.pointer_px_, now());
    self.dirty_ = true;
  });
  glfwSetCursorEnterCallback(window_.handle(), [](GLFWwindow* w, int entered) {
    Ui::on_enter(w, entered);
    input_of(w).dirty_ = true;
  });
  glfwSetScrollCallback(window_.handle(), [](GLFWwindow* w, double across, double steps) {
    Input& self = input_of(w);
    self.dirty_ = true;
    if (!Ui::on_scroll(w, across, steps)) self.navigator_.wheel(self.pointer_px_, steps, now());
  });
}

void Input::listen_to_keys() {
  glfwSetKeyCallback(window_.handle(), [](GLFWwindow* w, int key, int, int action, int modifiers) {
    input_of(w).on_key(key, action, modifiers, input_of(w).ui_.on_key(key, action));
  });
  // Letters and symbols arrive as characters, so that they follow the keyboard's layout.
  glfwSetCharCallback(window_.handle(), [](GLFWwindow* w, unsigned character) {
    input_of(w).dirty_ = true;
    if (!input_of(w).ui_.on_character(character)) input_of(w).on_character(character);
  });
}

void Input::listen_to_window() {
  glfwSetWindowFocusCallback(window_.handle(), [](GLFWwindow* w, int focused) {
    Ui::on_focus(w, focused);
    input_of(w).dirty_ = true;
  });
  glfwSetFramebufferSizeCallback(window_.handle(), [](GLFWwindow* w, int, int) { input_of(w).dirty_ = true; });
  glfwSetDropCallback(window_.handle(), [](GLFWwindow* w, int count, const char** paths) {
    for (int i = 0; i < count; ++i) input_of(w).dropped_.emplace_back(paths[i]);
    input_of(w).dirty_ = true;
  });
  glfwSetWindowContentScaleCallback(window_.handle(), [](GLFWwindow* w, float, float) {
    input_of(w).ui_.rescale(input_of(w).window_);
    input_of(w).dirty_ = true;
  });
  glfwSetWindowRefreshCallback(window_.handle(), [](GLFWwindow* w) { input_of(w).dirty_ = true; });
}

void Input::on_button(int button, int action, int modifiers) {
  if (button != GLFW_MOUSE_BUTTON_LEFT && button != GLFW_MOUSE_BUTTON_RIGHT) return;
  dirty_ = true;
  const PointerButton which = button == GLFW_MOUSE_BUTTON_LEFT ? PointerButton::left : PointerButton::right;
  const glm::dvec2 at = pointer_px_;
  const double slack_px = kClickSlack_px * window_.text_scale();
  if (action == GLFW_RELEASE) {
    navigator_.pointer_up(which, now(), late_);
    const auto pressed = std::exchange(pressed_px_, {});
    if (pressed && glm::distance(*pressed, at) <= slack_px) clicks_px_.push_back(at);
    return;
  }
  const bool ctrl = (modifiers & GLFW_MOD_CONTROL) != 0;
  if (which == PointerButton::left && !ctrl) pressed_px_ = at;
  if (which == PointerButton::left && !ctrl && clicks_.press(at, now(), slack_px) && double_clicks_) {
    navigator_.double_click(at, now());
  } else {
    navigator_.pointer_down(which, ctrl, at, now());
  }
}

// The globe gets no key that a panel took, except function keys and Esc, which closes the panel.
void Input::on_key(int key, int action, int modifiers, bool taken) {
  repeating_ = action == GLFW_REPEAT;
  dirty_ = true;
  if (action == GLFW_RELEASE || (taken && !function_key(key))) return;
  const auto moves = navigation_key(key);
  if (moves && (modifiers & GLFW_MOD_SHIFT) != 0) {
    tilt_by_key(*moves);
  } else if (moves) {
    navigator_.key(*moves, now());
  } else if (const auto asked = function_key(key); asked && !repeating_) {
    actions_.push_back(*asked);
  } else if (const auto measures = measuring_key(key); measures && !repeating_) {
    actions_.push_back(*measures);
  } else if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9 && !repeating_) {
    bookmark_ = {.number = key - GLFW_KEY_1 + 1, .set = (modifiers & GLFW_MOD_CONTROL) != 0};
  }
}

// Acts like a right drag around the picture's middle. Ignores keys while a button is held, and keys other than arrows.
void Input::tilt_by_key(NavigationKey key) {
  glm::dvec2 by_px(0.0);
  const double step_px = kTurnStep_px * window_.text_scale();
  if (key == NavigationKey::pan_left) by_px.x = step_px;
  if (key == NavigationKey::pan_right) by_px.x = -step_px;
  if (key == NavigationKey::pan_up) by_px.y = -step_px;
  if (key == NavigationKey::pan_down) by_px.y = step_px;
  if (by_px == glm::dvec2(0.0) || pressed_px_) return;
  const Viewport size = window_.framebuffer();
  const glm::dvec2 middle = 0.5 * glm::dvec2(size.width_px, size.height_px);
  navigator_.pointer_down(PointerButton::right, false, middle, now());
  navigator_.pointer_move(middle + by_px, now());
  navigator_.pointer_up(PointerButton::right, now());
}

void Input::on_character(unsigned character) {
  dirty_ = true;
  if (character == '+' || character == '=') return navigator_.key(NavigationKey::zoom_in, now());
  if (character == '-' || character == 0x2212) return navigator_.key(NavigationKey::zoom_out, now());
  if (repeating_) return;
  switch (character) {
    case 'n':
    case 'N':
      return navigator_.key(NavigationKey::north_up, now());
    case 'f':
    case 'F':
      return actions_.push_back(ViewerAction::toggle_full_screen);
    case 'g':
    case 'G':
      return actions_.push_back(ViewerAction::toggle_graticule);
    case 'p':
    case 'P':
      return actions_.push_back(ViewerAction::toggle_panel);
    case 'u':
    case 'U':
      return actions_.push_back(ViewerAction::next_alpha);
    case 'b':
    case 'B':
      return actions_.push_back(ViewerAction::toggle_sky);
    case 's':
    case 'S':
      return actions_.push_back(ViewerAction::next_stereo);
    case 'x':
    case 'X':
      return actions_.push_back(ViewerAction::toggle_underground);
    case 'l':
    case 'L':
      return actions_.push_back(ViewerAction::toggle_layers);
    case 'i':
    case 'I':
      return actions_.push_back(ViewerAction::picture);
    case 'm':
    case 'M':
      return actions_.push_back(ViewerAction::toggle_measuring);
    case '/':
      ui_.expect_text(true);
      return actions_.push_back(ViewerAction::find_place);
    case '?':
      return actions_.push_back(ViewerAction::toggle_help);
    default:
      return;
  }
}

}  // namespace terrella
