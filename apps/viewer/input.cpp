#include "apps/viewer/input.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <utility>

namespace terrella {
namespace {

constexpr Seconds kDoubleClick(0.4);
constexpr double kClickSlack_px = 6.0;  // at 96 dots per inch

Input& input_of(GLFWwindow* window) { return *static_cast<Input*>(glfwGetWindowUserPointer(window)); }

/// True for keys that act on the viewer even while a panel has the keyboard.
bool is_function_key(int key) { return key == GLFW_KEY_ESCAPE || key >= GLFW_KEY_F1; }

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

Input::Input(Window& window, Ui& ui, Navigator& navigator, std::span<const Action> actions)
    : window_(window),
      ui_(ui),
      navigator_(navigator),
      actions_(actions),
      pointer_px_(window.cursor_px()),
      heard_until_(now()) {
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

std::vector<InputEvent> Input::take_events() { return std::exchange(queued_, {}); }

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
    Input& self = input_of(w);
    if (!self.ui_.on_button(w, button, action, modifiers, self.pointer_unit()) || action == GLFW_RELEASE) {
      self.on_button(button, action, modifiers);
    }
  });
  glfwSetCursorPosCallback(window_.handle(), [](GLFWwindow* w, double x, double y) {
    Input& self = input_of(w);
    self.pointer_px_ = self.window_.to_px({x, y});
    self.dirty_ = true;
    if (self.dragging_) {
      self.dragger_(DragStep::move, self.pointer_px_);
    } else {
      self.navigator_.pointer_move(self.pointer_px_, now());
    }
  });
  glfwSetCursorEnterCallback(window_.handle(), [](GLFWwindow* w, int entered) {
    Ui::on_enter(w, entered);
    input_of(w).dirty_ = true;
  });
  glfwSetScrollCallback(window_.handle(), [](GLFWwindow* w, double across, double steps) {
    Input& self = input_of(w);
    self.dirty_ = true;
    if (!self.ui_.on_scroll(w, across, steps, self.pointer_unit()))
      self.navigator_.wheel(self.pointer_px_, steps, now());
  });
}

void Input::listen_to_keys() {
  glfwSetKeyCallback(window_.handle(), [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    Input& self = input_of(w);
    const bool taken = self.ui_.on_key(key, action);
    const bool with_ctrl = action == GLFW_PRESS && (modifiers & GLFW_MOD_CONTROL) != 0;
    if (with_ctrl && self.on_ctrl(glfwGetKeyName(key, scancode), modifiers)) return;
    self.on_key(key, action, modifiers, taken);
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
    input_of(w).ui_.rescale();
    input_of(w).dirty_ = true;
  });
  glfwSetWindowRefreshCallback(window_.handle(), [](GLFWwindow* w) { input_of(w).dirty_ = true; });
}

void Input::on_button(int button, int action, int modifiers) {
  dirty_ = true;
  if (button != GLFW_MOUSE_BUTTON_LEFT && button != GLFW_MOUSE_BUTTON_RIGHT) return on_further_button(button, action);
  const PointerButton which = button == GLFW_MOUSE_BUTTON_LEFT ? PointerButton::left : PointerButton::right;
  const glm::dvec2 at = pointer_px_;
  const double slack_px = kClickSlack_px * window_.text_scale();
  if (action == GLFW_RELEASE) return on_release(which, at, slack_px);
  const bool ctrl = (modifiers & GLFW_MOD_CONTROL) != 0;
  if (which == PointerButton::left && !ctrl && dragger_ && dragger_(DragStep::begin, at)) {
    dragging_ = true;
    return;
  }
  if (which == PointerButton::left && !ctrl) pressed_px_ = at;
  if (which == PointerButton::right) right_ = RightPress{at, navigator_.camera()};
  if (which == PointerButton::left && !ctrl && clicks_.press(at, now(), slack_px) && double_clicks_) {
    pressed_px_.reset();  // its first press was the click
    navigator_.double_click(at, now());
  } else {
    navigator_.pointer_down(which, ctrl, at, now());
  }
}

void Input::on_release(PointerButton which, glm::dvec2 at, double slack_px) {
  if (which == PointerButton::left && std::exchange(dragging_, false)) {
    dragger_(DragStep::end, at);
    return;
  }
  navigator_.pointer_up(which, now(), late_);
  if (which == PointerButton::right) {
    const auto pressed = std::exchange(right_, {});
    if (!pressed || glm::distance(pressed->at_px, at) > slack_px) return;
    navigator_.set_camera(pressed->camera);  // a click turns nothing, even if the hand moves a little
    queued_.push_back({.button = which, .at_px = at});
    return;
  }
  const auto pressed = std::exchange(pressed_px_, {});
  if (pressed && glm::distance(*pressed, at) <= slack_px) queued_.push_back({.button = which, .at_px = at});
}

void Input::on_further_button(int button, int action) {
  if (action != GLFW_PRESS) return;
  const auto found = std::ranges::find(actions_, button, &Action::mouse_button);
  if (found != actions_.end()) queued_.push_back({.action = &*found});
}

// The globe gets no key that a panel took, except function keys, Esc, which closes the panel, and Ctrl with a digit,
// which a text field keeps.
void Input::on_key(int key, int action, int modifiers, bool taken) {
  repeating_ = action == GLFW_REPEAT;
  dirty_ = true;
  const bool is_digit = key >= GLFW_KEY_1 && key <= GLFW_KEY_9, with_ctrl = (modifiers & GLFW_MOD_CONTROL) != 0;
  const bool stores = is_digit && with_ctrl && !Ui::has_text_field();
  if (action == GLFW_RELEASE || (taken && !is_function_key(key) && !stores)) return;
  if (const Action* found = action_of(key, modifiers); found != nullptr) return queue(*found);
  if (is_digit && !repeating_) bookmark_ = {.number = key - GLFW_KEY_1 + 1, .set = with_ctrl};
}

// The row with the most modifiers that are held.
const Action* Input::action_of(int key, int modifiers) const {
  unsigned held = 0;
  if ((modifiers & GLFW_MOD_SHIFT) != 0) held |= Action::shifted;
  if ((modifiers & GLFW_MOD_ALT) != 0) held |= Action::alted;
  const Action* best = nullptr;
  for (const Action& one : actions_) {
    const unsigned wanted = one.flags & Action::kModifiers;
    if (key <= 0 || (key != one.key && key != one.other_key) || (wanted & ~held) != 0) continue;
    if (best == nullptr || std::popcount(wanted) > std::popcount(best->flags & Action::kModifiers)) best = &one;
  }
  return best;
}

// The name of a key is its letter in the keyboard's layout; keys with Ctrl are no characters. A text field keeps its
// own keys with Ctrl. A row with Shift wins while Shift is held. True if an action runs.
bool Input::on_ctrl(const char* name, int modifiers) {
  if (name == nullptr || name[1] != '\0') return false;
  const Action* best = nullptr;
  for (const Action& one : actions_) {
    const bool free = (one.flags & Action::types) != 0 || !Ui::has_text_field();
    const bool shifted = (one.flags & Action::shifted) != 0;
    if ((one.flags & Action::ctrl) == 0 || !free || one.characters.find(char32_t(name[0])) == one.characters.npos)
      continue;
    if (shifted ? (modifiers & GLFW_MOD_SHIFT) != 0 : best == nullptr) best = &one;
  }
  if (best == nullptr) return false;
  dirty_ = true;
  repeating_ = false;
  queue(*best);
  return true;
}

void Input::on_character(unsigned character) {
  dirty_ = true;
  const bool capital = character >= 'A' && character <= 'Z';
  const char32_t low = capital ? character - 'A' + 'a' : character;
  const auto found = std::ranges::find_if(actions_, [low](const Action& one) {
    return (one.flags & Action::ctrl) == 0 && one.characters.find(low) != one.characters.npos;
  });
  if (found != actions_.end()) queue(*found);
}

void Input::queue(const Action& action) {
  if (repeating_ && (action.flags & Action::repeats) == 0) return;
  if ((action.flags & Action::types) != 0) ui_.expect_text(true);
  if ((action.flags & Action::passes) != 0) ui_.leave_panel();
  queued_.push_back({.action = &action});
}

}  // namespace terrella
