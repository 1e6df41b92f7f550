#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// An OpenGL 4.5 core context without a window, a display or a GPU: EGL, surfaceless or device platform
/// (engine/DESIGN.md, 14). The context is current on the calling thread during the object's whole life. thread: main
class HeadlessContext {
 public:
  [[nodiscard]] static Result<std::unique_ptr<HeadlessContext>> create();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  HeadlessContext() = default;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

/// A colour picture to render into and read back. thread: main
class OffscreenTarget {
 public:
  explicit OffscreenTarget(Viewport size);
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }
  /// Replaces the picture by one of the same size and form as read() returns.
  void write(std::span<const std::uint8_t> picture);
  /// Returns the picture as RGBA8, rows from the top.
  [[nodiscard]] std::vector<std::uint8_t> read() const;

 private:
  Viewport size_;
  gl::Texture color_;
  gl::Framebuffer framebuffer_;
};

}  // namespace terrella
