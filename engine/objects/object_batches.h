#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo/objects.h"
#include "objects/cut_objects.h"

namespace terrella {

/// What is drawn before the surface and what after it (paper 2, 2.2).
enum class ObjectPart { underground, above_ground };

/// Which objects of a part: `chosen` are those with through_surface (2.9's third mode).
enum class ObjectChoice { all, chosen, others };

/// A sphere (`size` its radius in metres) or a marker (its diameter in pixels) as the GPU keeps it; positions as
/// PatchVertex has them.
struct DotInstance {
  glm::vec3 high_m;
  glm::vec3 low_m;
  float size;
  ObjectColor color;
};
static_assert(sizeof(DotInstance) == 32);

/// A corner of lines. A piece begins at each that has a width, and leads to the one after it. Each line stands between
/// two more vertices, which say how its ends are mitred.
struct LineVertex {
  glm::vec3 high_m;
  glm::vec3 low_m;
  float width_px;
  ObjectColor color;
};
static_assert(sizeof(LineVertex) == 32);

struct FillVertex {
  glm::vec3 high_m;
  glm::vec3 low_m;
  ObjectColor color;
};
static_assert(sizeof(FillVertex) == 28);

/// Things of one kind, sorted by part, then by opacity (what is opaque first), then by choice, and in the scene's order
/// within these, areas by their height: what one draw takes lies together.
template <class T>
struct Batch {
  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  static constexpr std::size_t kBuckets = 8;

  std::vector<T> items;
  std::array<std::size_t, kBuckets + 1> first{};  ///< of each bucket, and the end

  [[nodiscard]] static std::size_t bucket(ObjectPart part, bool opaque, bool chosen) {
    return (part == ObjectPart::above_ground ? 4U : 0U) + (opaque ? 0U : 2U) + (chosen ? 1U : 0U);
  }
  [[nodiscard]] Range range(ObjectPart part, bool opaque, ObjectChoice choice) const {
    const std::size_t from = bucket(part, opaque, choice == ObjectChoice::chosen);
    const std::size_t to = bucket(part, opaque, choice != ObjectChoice::others) + 1;
    return {first[from], first[to] - first[from]};
  }
};

/// A scene as the GPU takes it.
struct ObjectBatches {
  Batch<DotInstance> spheres;
  Batch<DotInstance> markers;
  Batch<LineVertex> lines;  ///< a range of n vertices is n - 3 pieces
  std::vector<FillVertex> fill_vertices;
  Batch<std::uint32_t> fill_indices;
  std::size_t fills_dropped = 0;  ///< areas left out because the scene's would be more than kMostFillTriangles
};

/// A scene, and its lines and areas as cut_objects() cut them, maybe when the scene had other colours.
struct CutScene {
  const ObjectScene& scene;
  const CutObjects& cut;
};

/// Sorts what several scenes hold; a scene's objects lie over those of the scenes before it. thread: any
[[nodiscard]] ObjectBatches make_batches(std::span<const CutScene> scenes, const Ellipsoid& ellipsoid);
/// Cuts and sorts one scene. thread: any
[[nodiscard]] ObjectBatches make_batches(const ObjectScene& scene, const Ellipsoid& ellipsoid);

}  // namespace terrella
