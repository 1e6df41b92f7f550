// outside TILES GEOJSON OUTPUT.png: a globe in an OpenGL context that is not Terrella's.
#include <epoxy/egl.h>
#include <terrella/globe.h>
#include <terrella/render/offscreen.h>
#include <terrella/streaming/objects/geojson_objects.h>

#include <fstream>
#include <iostream>

using namespace terrella;

void open_context() {
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  eglInitialize(display, nullptr, nullptr);
  eglBindAPI(EGL_OPENGL_API);
  const EGLint wish[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wish);
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

int main(int, char** argv) {
  open_context();
  auto tiles = open_tile_set(argv[1]);
  auto quakes = read_geojson_objects(argv[2]);
  if (!tiles || !quakes) return 1;
  auto globe = Globe::create(GlobeOptions{.unlit = true}, *std::move(tiles));
  if (!globe) return std::cerr << globe.error().message << '\n', 1;
  if (!(*globe)->add_objects(quakes->scene)) return 1;
  (*globe)->set_camera({.eye = {.lat = Angle::degrees(-20), .lon = Angle::degrees(170), .height_m = 1e7}});
  const Viewport size{256, 256};
  const OffscreenTarget target(size);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  if (!(*globe)->render_until_settled(target.framebuffer(), size, deadline)) return 1;
  const auto png = encode_png({size.width_px, size.height_px, target.read()});
  std::ofstream(argv[3], std::ios::binary).write(reinterpret_cast<const char*>(png->data()), std::ssize(*png));
}
