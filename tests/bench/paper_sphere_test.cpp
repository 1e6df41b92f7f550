#include "apps/bench/baseline/paper_sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "apps/bench/baseline/headless_gl.h"
#include "apps/bench/baseline/paper_mesh.h"
#include "apps/bench/truth/judge.h"
#include "apps/bench/truth/noise_planet.h"

namespace terrella::bench {
namespace {

TEST(PaperMeshTest, HasThePapersCounts) {
  const PaperMesh mesh = paper_mesh(48);
  EXPECT_EQ(mesh.indices.size() / 3, 27648U);
  EXPECT_EQ(mesh.vertices.size(), 14598U) << "6 · 49² and two copies for each of the 96 quads on the antimeridian";
}

TEST(PaperMeshTest, CoversTheSphereOnceFacingOutward) {
  const PaperMesh mesh = paper_mesh(48);
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return glm::dvec3(mesh.vertices[mesh.indices[i + k]].unit); };
    const glm::dvec3 twice = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    EXPECT_GT(glm::dot(twice, corner(0)), 0.0);
    area += 0.5 * glm::length(twice);
  }
  constexpr double kFlatness = 0.002;  // chords of 1.9° or less: an eighth of their square, twice
  EXPECT_NEAR(area / (4.0 * 3.14159265358979), 1.0, kFlatness);
}

TEST(PaperMeshTest, NoTriangleSpansTheAntimeridian) {
  const PaperMesh mesh = paper_mesh(48);
  const auto at_pole = [](const PaperVertex& vertex) { return std::abs(vertex.unit.z) > 0.9999F; };
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const PaperVertex& vertex = mesh.vertices[mesh.indices[i]];
    const PaperVertex& next = mesh.vertices[mesh.indices[i - i % 3 + (i + 1) % 3]];
    if (at_pole(vertex) || at_pole(next)) continue;  // a pole has one u there, and all longitudes
    EXPECT_LE(std::abs(vertex.uv.x - next.uv.x), 0.5F);
  }
}

TEST(PaperSphereTest, DrawsWhatTheGroundTruthShows) {
  const HeadlessGl gl;
  const truth::Picture planet = truth::noise_planet({.width = 512, .height = 256});
  const truth::Spheroid body{6371000.0, 0.0};
  const truth::TruthCamera camera{.eye = {30, 20, 3 * body.a_m}, .heading_deg = 25};
  const PaperSphere sphere(planet, 48, 256);
  sphere.draw(camera, body.a_m);
  const truth::TruthImage image =
      truth::cast(planet, {}, body, camera, {.width = 256, .height = 256, .rays_per_side = 4});
  const truth::Judgement judgement = truth::judge(sphere.read_back(), image, body, {}, {});
  constexpr double kFacing_rms = 6.0;  // a wrong orientation leaves 60, a shift of a pixel over 10
  EXPECT_LT(judgement[truth::Zone::facing].rms, kFacing_rms);
  EXPECT_GT(sphere.frame_ms(camera, body.a_m, 1), 0.0);
}

}  // namespace
}  // namespace terrella::bench
