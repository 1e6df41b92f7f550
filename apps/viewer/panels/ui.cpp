#include "apps/viewer/panels/ui.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/theme.h"

namespace terrella {
namespace {

constexpr float kTopMargin = 0.8F;  // in text heights

// Fits text to the window. Where the window's units exceed pixels, the font is rendered at pixel size and displayed at
// unit size.
void fit_to(const Window& window) {
  const float unit_px = static_cast<float>(window.pixels_per_unit().x);
  Ui::use_text(window.text_scale() / unit_px, unit_px);
}

/// True for a window that the program drew in this frame.
bool is_panel(const ImGuiWindow& window) {
  return window.Active && !window.IsFallbackWindow && window.RootWindow == &window;
}

/// True for texts, which take neither mouse nor keyboard.
bool is_text(const ImGuiWindow& window) {
  return (window.Flags & ImGuiWindowFlags_NoInputs) == ImGuiWindowFlags_NoInputs;
}

bool takes_events() { return (ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0; }

/// True for keys that panels use; letters only act with Ctrl.
bool panels_act_on(int key) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool letter = key >= GLFW_KEY_A && key <= GLFW_KEY_Z;
  return (!letter || io.KeyCtrl) && std::ranges::find(io.KeyMap, key) != std::end(io.KeyMap);
}

/// The part of a name that stays the same while the title changes.
std::string name_of(const ImGuiWindow& window) {
  const std::string_view name = window.Name;
  const auto fixed = name.rfind("###");
  return std::string(fixed == name.npos ? name : name.substr(fixed));
}

UiBox box_of(const ImGuiWindow& window) {
  return {window.Pos.x, window.Pos.y, window.Pos.x + window.Size.x, window.Pos.y + window.Size.y};
}

}  // namespace

Ui::Ui(const Window& window) : window_(window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
  fit_to(window);
  ImGui_ImplGlfw_InitForOpenGL(window.handle(), false);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Ui::~Ui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Ui::begin_frame() {
  ImGui_ImplOpenGL3_NewFrame();
  if (std::exchange(rescaled_, false) || letters_wait()) {
    fit_to(window_);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  ImGui_ImplGlfw_NewFrame();
  hand_over_waiting();
  ImGui::NewFrame();
}

void Ui::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Ui::take_events(bool on) {
  int& flags = ImGui::GetIO().ConfigFlags;
  flags = ImGuiConfigFlags_NoMouseCursorChange | (on ? int(ImGuiConfigFlags_NavEnableKeyboard) : 0);
}

// Looks at the last frame's panels. ImGui's own answer is about the pointer's place in the last frame.
bool Ui::is_over_panel(glm::dvec2 at) {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  if (has_open_list()) return true;
  return std::ranges::any_of(context.Windows, [at](const ImGuiWindow* window) {
    if (!window->Active || window->Hidden || window->IsFallbackWindow) return false;
    if ((window->Flags & ImGuiWindowFlags_NoMouseInputs) != 0) return false;
    return window->Rect().Contains({float(at.x), float(at.y)});
  });
}

glm::dvec2 Ui::size_of(const char* title) {
  const ImGuiWindow* window = ImGui::FindWindowByName(title);
  return window == nullptr ? glm::dvec2(0.0) : glm::dvec2(window->Size.x, window->Size.y);
}

bool Ui::has_text_field() { return ImGui::GetIO().WantTextInput; }

bool Ui::has_open_list() { return ImGui::GetCurrentContext()->OpenPopupStack.Size > 0; }

void Ui::show_focus() { ImGui::GetCurrentContext()->NavDisableHighlight = false; }

bool Ui::panel_has_keyboard() { return ImGui::GetIO().NavActive; }

void Ui::pass_keyboard(const char* title) { ImGui::SetWindowFocus(panel_has_keyboard() ? nullptr : title); }

// ImGui itself notices two frames after pass_keyboard() that no field takes characters.
void Ui::leave_panel() {
  if (!panel_has_keyboard()) return;
  ImGui::GetIO().WantTextInput = ImGui::GetIO().WantCaptureKeyboard = false;
  ImGui::GetCurrentContext()->WantTextInputNextFrame = 0;
  expect_text(false);
}

bool Ui::has_waiting() const { return !waiting_.empty() || letters_wait(); }

bool Ui::on_button(GLFWwindow* window, int button, int action, int modifiers, glm::dvec2 at) const {
  ImGui_ImplGlfw_MouseButtonCallback(window, button, action, modifiers);
  return mouse_held_ || is_over_panel(at);
}

bool Ui::on_scroll(GLFWwindow* window, double x, double y, glm::dvec2 at) const {
  ImGui_ImplGlfw_ScrollCallback(window, x, y);
  return mouse_held_ || is_over_panel(at);
}

bool Ui::on_key(int key, int action) {
  const bool known = key >= 0 && key < IM_ARRAYSIZE(ImGui::GetIO().KeysDown);
  if (known && action == GLFW_PRESS) waiting_.push_back({Stroke::press, unsigned(key)});
  if (known && action == GLFW_RELEASE) waiting_.push_back({Stroke::release, unsigned(key)});
  return takes_events() && ImGui::GetIO().WantCaptureKeyboard;
}

bool Ui::on_character(unsigned character) {
  const bool keeps = text_expected_ || (takes_events() && ImGui::GetIO().WantTextInput);
  if (keeps) waiting_.push_back({Stroke::character, character});
  return keeps;
}

// Passes waiting events to ImGui, which reads keys once a frame. A frame gets at most one change of a key that panels
// use, and no later event. ImGui therefore misses no quick release or double press, and characters keep their order
// with Backspace.
void Ui::hand_over_waiting() {
  if (field_ready_) text_expected_ = false;
  bool acts = false;
  while (!waiting_.empty() && !acts) {
    const KeyEvent event = waiting_.front();
    if (event.stroke == Stroke::character) {
      if (text_expected_) return;
      ImGui::GetIO().AddInputCharacter(event.code);
    } else {
      const int key = int(event.code), action = event.stroke == Stroke::press ? GLFW_PRESS : GLFW_RELEASE;
      ImGui_ImplGlfw_KeyCallback(nullptr, key, 0, action, 0);
      acts = takes_events() && panels_act_on(key);
    }
    waiting_.pop_front();
  }
}

void Ui::expect_text(bool on) {
  text_expected_ = on;
  field_ready_ = false;
  if (!on) std::erase_if(waiting_, [](const KeyEvent& event) { return event.stroke == Stroke::character; });
}

void Ui::on_enter(GLFWwindow* window, int entered) { ImGui_ImplGlfw_CursorEnterCallback(window, entered); }

void Ui::on_focus(GLFWwindow* window, int focused) { ImGui_ImplGlfw_WindowFocusCallback(window, focused); }

void Ui::use_text(float scale, float unit_px) {
  load_panel_fonts(scale * unit_px);
  ImGui::GetIO().FontGlobalScale = 1.0F / unit_px;
  set_theme(scale);
}

double Ui::text_height() { return double(ImGui::GetFontSize()); }

std::vector<UiBox> Ui::panel_boxes() {
  std::vector<UiBox> boxes;
  const ImGuiWindow* menu = ImGui::FindWindowByName(kMenuTitle);
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    const bool over_panels = (window->Flags & (ImGuiWindowFlags_Tooltip | ImGuiWindowFlags_Popup)) != 0;
    if (is_panel(*window) && window != menu && !over_panels) boxes.push_back(box_of(*window));
  }
  return boxes;
}

std::optional<UiBox> Ui::panel_box(const char* title) {
  const ImGuiWindow* window = ImGui::FindWindowByName(title);
  return window == nullptr ? std::nullopt : std::optional(box_of(*window));
}

std::optional<UiBox> Ui::shown_box(const char* title) {
  const ImGuiWindow* window = ImGui::FindWindowByName(title);
  return window != nullptr && window->Active ? std::optional(box_of(*window)) : std::nullopt;
}

std::string Ui::boxes_text(const std::vector<UiBox>& labels) {
  const auto numbers = [](const UiBox& box) { return nlohmann::json{box.left, box.top, box.right, box.bottom}; };
  nlohmann::json all = {
      {"panels", nlohmann::json::object()}, {"labels", nlohmann::json::array()}, {"cut", nlohmann::json::array()}};
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    if (!is_panel(*window)) continue;
    const std::string name = name_of(*window);
    all["panels"][name] = numbers(box_of(*window));
    // Small panels beside the globe fit their contents a frame later.
    const bool fits = (window->Flags & (ImGuiWindowFlags_NoNav | ImGuiWindowFlags_HorizontalScrollbar)) != 0;
    if (!fits && window->ContentSizeIdeal.x > window->WorkRect.GetWidth() + 1.0F) all["cut"].push_back(name);
  }
  for (const UiBox& label : labels) all["labels"].push_back(numbers(label));
  return all.dump();
}

std::vector<UiBox> Ui::last_panels() {
  std::vector<UiBox> boxes;
  const ImGuiWindow* menu = ImGui::FindWindowByName(kMenuTitle);
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    const bool drawn = window->WasActive && !window->IsFallbackWindow && window->RootWindow == window;
    const bool passing = (window->Flags & (ImGuiWindowFlags_Tooltip | ImGuiWindowFlags_Popup)) != 0;
    if (drawn && !passing && window != menu && !is_text(*window)) boxes.push_back(box_of(*window));
  }
  return boxes;
}

UiBox Ui::panel_room(float left, float right, float foot) {
  const double margin = double(kTopMargin) * text_height(), height = double(ImGui::GetIO().DisplaySize.y);
  UiBox room{left, margin, right, height - double(foot) - margin};
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    const UiBox box = box_of(*window);
    if (!is_panel(*window) || !is_text(*window) || box.left >= room.right || box.right <= room.left) continue;
    if (0.5 * (box.top + box.bottom) < 0.5 * height) {
      room.top = std::max(room.top, box.bottom + margin);
    } else {
      room.bottom = std::min(room.bottom, box.top - 0.5 * margin);
    }
  }
  return room;
}

}  // namespace terrella
