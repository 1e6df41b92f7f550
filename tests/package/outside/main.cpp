// outside TILES OVERLAY GEOJSON OUTPUT.png: a globe in an OpenGL context that is not Terrella's.
#include <epoxy/egl.h>
#include <terrella/globe.h>
#include <terrella/render/gl/offscreen.h>
#include <terrella/streaming/objects/geojson_objects.h>
#include <terrella/streaming/sets/open_tile_set.h>

#include <fstream>

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
  const auto globe = Globe::create({.unlit = true});
  auto earth = open_tile_set(argv[1]), overlay = open_tile_set(argv[2]);
  auto quakes = read_geojson_objects(argv[3]);
  if (!globe || !earth || !overlay || !quakes) return 1;
  Globe& g = **globe;
  if (!g.add_imagery(*std::move(earth)) || !g.add_imagery(*std::move(overlay)) || !g.add_objects(quakes->scene))
    return 2;
  g.set_camera({.eye = {.lat = Angle::degrees(-20), .lon = Angle::degrees(170), .height_m = 1e7}});
  const Viewport size{256, 256};
  const OffscreenTarget target(size);
  if (!g.render_until_settled(target.framebuffer(), size, std::chrono::steady_clock::now() + std::chrono::minutes(1)))
    return 3;
  const auto png = encode_png({size.width_px, size.height_px, target.read()});
  std::ofstream(argv[4], std::ios::binary).write(reinterpret_cast<const char*>(png->data()), std::ssize(*png));
  return 0;
}
