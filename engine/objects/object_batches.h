#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "geo/objects.h"

// Paper 2: "Interactive visualization of 3D data on a virtual globe in stereoscopic systems", abstract of a
// dissertation, chapter 2.2.

namespace terrella {

/// Objects drawn before the surface and objects drawn after it (paper 2, 2.2).
enum class ObjectPart { underground, above_ground };

/// A choice of objects of a part: `chosen` are those with through_surface (paper 2, 2.9, third mode).
enum class ObjectChoice { all, chosen, others };

/// A sphere (`size` is its radius in metres) or a marker (`size` is its diameter in pixels) in the layout for the GPU.
/// Positions are split as in PatchVertex.
struct DotInstance {
  glm::vec3 high_m;
  glm::vec3 low_m;
  float size;
  ObjectColor color;
};
static_assert(sizeof(DotInstance) == 32);

/// An icon. `up` is the direction of the picture's upper edge: Earth-fixed, or, if its w is 1, on the screen (y up).
struct IconInstance {
  glm::vec3 high_m;
  glm::vec3 low_m;
  glm::vec4 up;
  glm::vec2 anchor;
  float size_px;
  std::uint32_t image;           ///< index in LayerBatches::icon_images
  ObjectColor color;             ///< factor of colours and alpha
  ObjectColor wash{0, 0, 0, 0};  ///< mixed in by its alpha
};
static_assert(sizeof(IconInstance) == 64);

/// A vertex of lines. Each vertex with a width begins a piece that leads to the next vertex. One more vertex before and
/// one after each line define the mitres of its ends.
struct LineVertex {
  glm::vec3 high_m;
  glm::vec3 low_m;
  float width_px;
  ObjectColor color;
  /// Lengths of a line with gaps (LineDashes): of the line before the vertex, in metres, modulo kDashesWrap of the
  /// dashes' periods; and of the piece. Else 0.
  float along_m, length_m;
  std::uint16_t on, off;  ///< lengths of dashes and gaps, 1/8 px
};
static_assert(sizeof(LineVertex) == 44);
/// Lengths along dashed lines begin again after this many metres for each pixel of a period.
inline constexpr double kDashesWrap = 32768.0;

struct FillVertex {
  glm::vec3 high_m;
  glm::vec3 low_m;
  ObjectColor color;
};
static_assert(sizeof(FillVertex) == 28);

/// A corner of a triangle of an extruded area. Positions are Earth-fixed; both sides of a triangle are drawn.
struct SolidVertex {
  glm::vec3 high_m;
  glm::vec3 low_m;
  glm::vec3 normal;  ///< outwards, unit, Earth-fixed
  ObjectColor color;
};
static_assert(sizeof(SolidVertex) == 40);

/// Objects of one kind, sorted by part, then by opacity (opaque first), then by choice. Within these, objects keep the
/// layer's order. So each draw takes one contiguous range.
template <class T>
struct Batch {
  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  static constexpr std::size_t kBuckets = 8;

  std::vector<T> items;
  std::array<std::size_t, kBuckets + 1> first{};  ///< begin of each bucket, and the end of the last

  [[nodiscard]] static std::size_t bucket(ObjectPart part, bool opaque, bool chosen) {
    return (part == ObjectPart::above_ground ? 4U : 0U) + (opaque ? 0U : 2U) + (chosen ? 1U : 0U);
  }
  [[nodiscard]] static bool is_opaque(std::size_t bucket) { return (bucket & 2U) == 0; }
  [[nodiscard]] Range range(ObjectPart part, bool opaque, ObjectChoice choice) const {
    const std::size_t from = bucket(part, opaque, choice == ObjectChoice::chosen);
    const std::size_t to = bucket(part, opaque, choice != ObjectChoice::others) + 1;
    return {first[from], first[to] - first[from]};
  }
};

/// One place of a model: its position, the model's axes in metres, and a colour that is mixed in by its alpha.
struct MeshStand {
  glm::vec3 high_m;
  glm::vec3 low_m;
  std::array<glm::vec3, 3> ecef_from_model;  ///< axes of length 0: not drawn
  ObjectColor tint{0, 0, 0, 0};
};
static_assert(sizeof(MeshStand) == 64);

}  // namespace terrella
