#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>

#include "apps/bench/truth/picture.h"
#include "apps/bench/truth/ray_caster.h"

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella::bench {

/// Texturing of the sphere.
struct PaperLook {
  enum class Method {
    plain,  ///< interpolated u, v; the texture unit chooses the level
    bands,  ///< paper 1's method: u, v and level by (5) and (6) for each fragment of a pole band, plain elsewhere
    exact,  ///< u, v and their derivatives for each fragment; the texture unit chooses the level from these
  };
  Method method = Method::plain;
  double a = 4.0;           ///< a of (6)
  double band = 0.05;       ///< b of (5)
  double anisotropy = 1.0;  ///< anisotropy of the texture unit, 1 to 16; unused by `bands` inside the bands
};

/// Paper 1's sphere. Its plain look defines 1.0 in this project's benchmarks: the cube
/// sphere with n = 48, one RGBA8 texture with mipmaps, trilinear, unlit. One draw call fills a 1024×1024 RGBA8 target
/// with 24-bit depth. Needs a current OpenGL 4.5 core context, which must outlive the object. thread: the context's.
class PaperSphere {
 public:
  /// Uploads the equirectangular picture and creates its mipmaps.
  explicit PaperSphere(const truth::Picture& picture, int n = 48, int size_px = 1024);
  ~PaperSphere();
  PaperSphere(const PaperSphere&) = delete;
  PaperSphere& operator=(const PaperSphere&) = delete;

  /// Clears the target and draws the sphere. Returns once GL has the commands.
  void draw(const truth::TruthCamera& camera, double radius_m, const PaperLook& look = {}) const;
  /// Clears the target, as draw() does first.
  void clear() const;
  [[nodiscard]] int triangles() const { return index_count_ / 3; }
  [[nodiscard]] int vertices() const { return vertex_count_; }
  /// Median frame time from clear to glFinish in milliseconds, after two warm-up frames. frames ≥ 1.
  [[nodiscard]] double frame_ms(const truth::TruthCamera& camera, double radius_m, int frames) const;
  /// The last drawn picture, top row first.
  [[nodiscard]] truth::Picture read_back() const;

 private:
  void make_programs();
  void make_mesh(int n);
  void make_texture(const truth::Picture& picture);
  void make_target();

  int size_px_;
  int index_count_ = 0, vertex_count_ = 0;
  std::array<std::uint32_t, 3> programs_{};  // by PaperLook::Method
  std::uint32_t texture_ = 0, vertex_array_ = 0, vertices_ = 0, indices_ = 0;
  std::uint32_t framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

/// Matrix from the unit sphere's coordinates to clip space, for a camera over a sphere of this radius and a square
/// picture.
[[nodiscard]] glm::mat4 clip_from_unit_sphere(const truth::TruthCamera& camera, double radius_m);

}  // namespace terrella::bench
