#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "base/result.h"
#include "geo/camera.h"

struct GLFWwindow;

namespace terrella {

/// A window with an OpenGL 4.5 core context, which is current from then on. One at a time.
/// thread: main for every call
class Window {
 public:
  /// Made hidden; show() shows it. Fails without a display or without OpenGL 4.5, and the message says which and what
  /// to do instead.
  [[nodiscard]] static Result<std::unique_ptr<Window>> create(const std::string& title, Viewport size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void show();
  void toggle_full_screen();
  /// Its size, in its own coordinates, when it does not fill the screen.
  [[nodiscard]] Viewport windowed() const;
  [[nodiscard]] GLFWwindow* handle() const { return window_; }
  /// Pixels of the framebuffer; 0 × 0 while the window is minimised.
  [[nodiscard]] Viewport framebuffer() const;
  /// A cursor's place in the window's own coordinates as framebuffer pixels, pixel centres at halves.
  [[nodiscard]] glm::dvec2 to_px(glm::dvec2 at) const;
  /// Where the cursor is now, framebuffer pixels.
  [[nodiscard]] glm::dvec2 cursor_px() const;
  /// How much larger than at 96 dots per inch text must be, in framebuffer pixels.
  [[nodiscard]] float text_scale() const;
  /// Framebuffer pixels per unit of the window's own coordinates.
  [[nodiscard]] glm::dvec2 pixels_per_unit() const;

 private:
  explicit Window(GLFWwindow* window) : window_(window) {}
  struct Placement {
    int x = 0, y = 0, width = 0, height = 0;
  };
  GLFWwindow* window_;
  Placement windowed_;  ///< where to go back to from full screen
};

}  // namespace terrella
