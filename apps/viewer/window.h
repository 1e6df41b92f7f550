#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "base/result.h"
#include "geo/camera.h"

struct GLFWwindow;

namespace terrella {

/// A window with an OpenGL 4.5 core context, current after creation. Only one instance may exist at a time. thread:
/// main for every call
class Window {
 public:
  /// Creates a hidden window; show() shows it. Fails without a display or OpenGL 4.5; the message states the cause and
  /// an alternative.
  [[nodiscard]] static Result<std::unique_ptr<Window>> create(const std::string& title, Viewport size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void show();
  void toggle_full_screen();
  /// Puts a text into the clipboard, UTF-8.
  void copy(const std::string& text) const;
  /// Size in the window's own coordinates when not in full screen.
  [[nodiscard]] Viewport windowed() const;
  [[nodiscard]] GLFWwindow* handle() const { return window_; }
  /// Pixels of the framebuffer; 0 × 0 while the window is minimised.
  [[nodiscard]] Viewport framebuffer() const;
  /// Converts a position from the window's own coordinates to framebuffer pixels, with pixel centres at halves.
  [[nodiscard]] glm::dvec2 to_px(glm::dvec2 at) const;
  /// Current cursor position, framebuffer pixels.
  [[nodiscard]] glm::dvec2 cursor_px() const;
  /// Text scale relative to 96 dots per inch, in framebuffer pixels.
  [[nodiscard]] float text_scale() const;
  /// Framebuffer pixels per unit of the window's own coordinates.
  [[nodiscard]] glm::dvec2 pixels_per_unit() const;

 private:
  explicit Window(GLFWwindow* window) : window_(window) {}
  struct Placement {
    int x = 0, y = 0, width = 0, height = 0;
  };
  GLFWwindow* window_;
  Placement windowed_;  ///< placement to restore after full screen
};

}  // namespace terrella
