#include "apps/viewer/window.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>

#include <algorithm>

namespace terrella {
namespace {

constexpr int kSamples = 0;  // the globe antialiases its limb itself

std::string last_glfw_error() {
  const char* why = nullptr;
  glfwGetError(&why);
  return why != nullptr ? why : "no reason given";
}

Error no_window(const std::string& what) {
  return Error{what + " (" + last_glfw_error() +
               "); `terrella render` makes pictures without a display, for example `terrella render -o globe.png`"};
}

void hint_context() {
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SAMPLES, kSamples);
  // The globe has its own depth and stencil; window buffers would only waste memory.
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

/// Reduces a size to the screen's work area.
Viewport fitted(Viewport size) {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return size;
  int x = 0, y = 0, width = 0, height = 0;
  glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
  if (width > 0 && height > 0) size = {std::min(size.width_px, width), std::min(size.height_px, height)};
  return size;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(const std::string& title, Viewport size) {
  if (glfwInit() != GLFW_TRUE) return no_window("cannot open a window: no display");
  hint_context();
  const Viewport fit = fitted(size);
  GLFWwindow* handle = glfwCreateWindow(fit.width_px, fit.height_px, title.c_str(), nullptr, nullptr);
  if (handle == nullptr) {
    const Error error = no_window("cannot open a window with OpenGL 4.5");
    glfwTerminate();
    return error;
  }
  glfwMakeContextCurrent(handle);
  glfwSwapInterval(1);
  return std::unique_ptr<Window>(new Window(handle));
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::show() {
  glfwShowWindow(window_);
  glfwFocusWindow(window_);
}

void Window::toggle_full_screen() {
  if (glfwGetWindowMonitor(window_) != nullptr) {
    glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.width, windowed_.height, GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
  glfwGetWindowSize(window_, &windowed_.width, &windowed_.height);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::copy(const std::string& text) const { glfwSetClipboardString(window_, text.c_str()); }

Viewport Window::windowed() const {
  if (glfwGetWindowMonitor(window_) != nullptr) return {windowed_.width, windowed_.height};
  Viewport size{0, 0};
  glfwGetWindowSize(window_, &size.width_px, &size.height_px);
  return size;
}

Viewport Window::framebuffer() const {
  Viewport size{0, 0};
  glfwGetFramebufferSize(window_, &size.width_px, &size.height_px);
  return size;
}

glm::dvec2 Window::pixels_per_unit() const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const Viewport pixels = framebuffer();
  if (width <= 0 || height <= 0 || pixels.width_px <= 0 || pixels.height_px <= 0) return glm::dvec2(1.0);
  return {double(pixels.width_px) / width, double(pixels.height_px) / height};
}

glm::dvec2 Window::cursor_px() const {
  glm::dvec2 at(0.0);
  glfwGetCursorPos(window_, &at.x, &at.y);
  return to_px(at);
}

glm::dvec2 Window::to_px(glm::dvec2 at) const {
  // Window systems name a pixel by its corner; its middle is half a unit further.
  return (at + 0.5) * pixels_per_unit();
}

float Window::text_scale() const {
  float x = 1.0F, y = 1.0F;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(std::max(x, y), 0.5F, 4.0F);
}

}  // namespace terrella
