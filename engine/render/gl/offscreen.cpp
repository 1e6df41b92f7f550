#include "render/gl/offscreen.h"

#include <epoxy/egl.h>

#include <algorithm>
#include <mutex>

namespace terrella {
namespace {

/// Contexts of a display share it, and eglTerminate() ends it for all of them: the last one calls it.
std::mutex g_displays;
int g_contexts = 0;

EGLDisplay find_display() {
  EGLDisplay display = EGL_NO_DISPLAY;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE) return display;
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    eglQueryDevicesEXT(16, devices, &count);
    for (EGLint k = 0; k < count; ++k) {
      display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[k], nullptr);
      if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE) return display;
    }
  }
  return EGL_NO_DISPLAY;
}

EGLDisplay open_display() {
  const std::lock_guard lock(g_displays);
  EGLDisplay display = find_display();
  if (display != EGL_NO_DISPLAY) ++g_contexts;
  return display;
}

void close_display(EGLDisplay display) {
  const std::lock_guard lock(g_displays);
  if (--g_contexts == 0) eglTerminate(display);
}

/// RGBA8 with its rows in the reverse order.
std::vector<std::uint8_t> upside_down(std::span<const std::uint8_t> rows, Viewport size) {
  const auto row = static_cast<std::size_t>(size.width_px) * 4;
  std::vector<std::uint8_t> turned(rows.size());
  for (std::size_t from = 0; from < rows.size(); from += row) {
    std::copy_n(rows.data() + from, row, turned.data() + rows.size() - row - from);
  }
  return turned;
}

}  // namespace

Result<std::unique_ptr<HeadlessContext>> HeadlessContext::create() {
  std::unique_ptr<HeadlessContext> self(new HeadlessContext);
  self->display_ = open_display();
  if (self->display_ == EGL_NO_DISPLAY) {
    return Error{
        "no EGL display without a window system: install Mesa's EGL (Debian: libegl1, libgl1-mesa-dri) or a GPU "
        "driver"};
  }
  eglBindAPI(EGL_OPENGL_API);
  const EGLint config_wish[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  eglChooseConfig(self->display_, config_wish, &config, 1, &configs);
  const EGLint wish[] = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLContext context = eglCreateContext(self->display_, configs > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wish);
  if (context == EGL_NO_CONTEXT) return Error{"EGL has no OpenGL 4.5 core context: update Mesa or the GPU driver"};
  self->context_ = context;
  if (eglMakeCurrent(self->display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
    return Error{"EGL cannot make a context current without a surface"};
  }
  return self;
}

HeadlessContext::~HeadlessContext() {
  if (display_ == EGL_NO_DISPLAY) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != nullptr) eglDestroyContext(display_, context_);
  close_display(display_);
}

OffscreenTarget::OffscreenTarget(Viewport size)
    : size_(size), color_(gl::make_texture(GL_TEXTURE_2D)), framebuffer_(gl::make_framebuffer()) {
  glTextureStorage2D(color_.name(), 1, GL_RGBA8, size.width_px, size.height_px);
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
}

void OffscreenTarget::write(std::span<const std::uint8_t> picture) {
  const std::vector<std::uint8_t> bottom_up = upside_down(picture, size_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(color_.name(), 0, 0, 0, size_.width_px, size_.height_px, GL_RGBA, GL_UNSIGNED_BYTE,
                      bottom_up.data());
}

std::vector<std::uint8_t> OffscreenTarget::read() const {
  std::vector<std::uint8_t> bottom_up(std::size_t(4) * static_cast<std::size_t>(size_.width_px) *
                                      static_cast<std::size_t>(size_.height_px));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(color_.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(bottom_up.size()),
                    bottom_up.data());
  return upside_down(bottom_up, size_);
}

}  // namespace terrella
