// ten_lines TILES: shows a turning planet in a window.
#include <GLFW/glfw3.h>
#include <terrella/globe.h>
#include <terrella/streaming/sets/open_tile_set.h>

#include <iostream>

using namespace terrella;

// The ten lines that use Terrella.
bool turn(GLFWwindow* window, const char* path) {
  auto tiles = open_tile_set(path);
  if (!tiles) return std::cerr << tiles.error().message << '\n', false;
  GlobeOptions options;
  options.sky = true;
  auto globe = Globe::create(options, *std::move(tiles));
  if (!globe) return std::cerr << globe.error().message << '\n', false;
  for (Camera camera; glfwWindowShouldClose(window) == 0; glfwPollEvents()) {
    camera.eye.lon = Angle::degrees(10 * glfwGetTime());
    Viewport size;
    glfwGetFramebufferSize(window, &size.width_px, &size.height_px);
    (*globe)->set_camera(camera);
    (*globe)->render(0, size);
    glfwSwapBuffers(window);
  }
  return true;
}

int main(int argc, char** argv) {
  if (argc != 2) return std::cerr << "ten_lines TILES\n", 2;
  if (glfwInit() == 0) return std::cerr << "no display\n", 1;
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  GLFWwindow* window = glfwCreateWindow(800, 600, "Ten lines", nullptr, nullptr);
  if (window == nullptr) return std::cerr << "no window with OpenGL 4.5\n", 1;
  glfwMakeContextCurrent(window);
  const bool good = turn(window, argv[1]);
  glfwTerminate();
  return good ? 0 : 1;
}
