#include "apps/bench/baseline/paper_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace terrella::bench {
namespace {

struct Face {
  glm::dvec3 normal, tangent, bitangent;  // right-handed: tangent × bitangent = normal
};
constexpr std::array<Face, 6> kFaces{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                      {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
                                      {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                                      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                      {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                                      {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}}};

PaperVertex vertex_at(const Face& face, int i, int j, int n) {
  const double s = 2.0 * i / n - 1.0;
  const double t = 2.0 * j / n - 1.0;
  const glm::dvec3 p = glm::normalize(face.normal + s * face.tangent + t * face.bitangent);
  const double u = 0.5 + std::atan2(p.y, p.x) / (2.0 * std::numbers::pi);
  const double v = 0.5 - std::asin(p.z) / std::numbers::pi;
  return {glm::vec3(p), glm::vec2(static_cast<float>(u), static_cast<float>(v))};
}

using Quad = std::array<std::uint32_t, 4>;  // a ring, counter-clockwise

void unwrap(PaperMesh& mesh, Quad& quad) {
  const auto u_of = [&mesh](std::uint32_t index) { return mesh.vertices[index].uv.x; };
  const auto [low, high] = std::minmax({u_of(quad[0]), u_of(quad[1]), u_of(quad[2]), u_of(quad[3])});
  if (high - low <= 0.5F) return;
  for (std::uint32_t& corner : quad) {
    if (u_of(corner) >= 0.5F) continue;
    PaperVertex copy = mesh.vertices[corner];
    copy.uv.x += 1.0F;
    corner = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(copy);
  }
}

void add_triangles(PaperMesh& mesh, const Quad& q, bool forward) {
  const auto add = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    mesh.indices.insert(mesh.indices.end(), {x, y, z});
  };
  if (forward) {
    add(q[0], q[1], q[2]);
    add(q[0], q[2], q[3]);
  } else {
    add(q[0], q[1], q[3]);
    add(q[1], q[2], q[3]);
  }
}

void add_face(PaperMesh& mesh, const Face& face, int n) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.vertices.push_back(vertex_at(face, i, j, n));
  }
  const auto index = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      Quad quad{index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)};
      unwrap(mesh, quad);
      const bool first_or_third_quadrant = (2 * i >= n) == (2 * j >= n);
      add_triangles(mesh, quad, first_or_third_quadrant);
    }
  }
}

}  // namespace

PaperMesh paper_mesh(int n) {
  PaperMesh mesh;
  for (const Face& face : kFaces) add_face(mesh, face, n);
  return mesh;
}

}  // namespace terrella::bench
