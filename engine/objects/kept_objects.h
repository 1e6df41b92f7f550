#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geo/split_position.h"
#include "objects/cut_objects.h"
#include "objects/ground/ground_batch.h"
#include "objects/object_pick.h"
#include "objects/object_picker.h"
#include "objects/slot_batch.h"

// Objects as a layer keeps them. thread: any, but one call at a time
namespace terrella {

/// A part of a feature: an object in one of the layer's lists.
struct PartRef {
  static constexpr std::uint32_t kNone = ~0U;
  ObjectKind kind = ObjectKind::point;
  std::uint32_t index = kNone;
  [[nodiscard]] explicit operator bool() const { return index != kNone; }
};

struct Kept {
  PartRef next{};            ///< the next part of the same feature
  std::uint32_t number = 0;  ///< PickedObject::index
  bool visible = true, filtered = false, selected = false, removed = false;
  /// Lines and areas: the last job to cut the object, and the job of the cut that it has.
  std::uint32_t asked_number = 0, placed_number = 0;
  [[nodiscard]] bool is_shown() const { return visible && !filtered; }
};

/// The end of a line that an arrow marks.
enum class LineEnd : std::uint8_t { none, start, end };

struct KeptPoint : Kept {
  PointObject object;
  glm::dvec3 place_m{0.0};
  Slot slot = {};           ///< slot of a disc or an icon
  std::uint32_t image = 0;  ///< index of an icon's picture in LayerBatches::icon_images
  LineEnd arrow = LineEnd::none;
  bool has_direction = true;  ///< false: an arrow of a line without length
};

/// The place of a line or an area on the ground, which has no slots.
struct KeptOnGround {
  bool lies = false;  ///< lies_on_ground() when it was cut
  std::shared_ptr<const GroundShape> shape = {};
  std::uint32_t place = GroundBatch::kNone;  ///< in LayerBatches::ground
};

/// The place of a part in a line that grows. It begins and ends where its neighbours end and begin.
struct LinePart {
  bool is_part = false;
  std::optional<Geodetic> before = {}, after = {};  ///< places of the neighbours next to its ends
  double from_rad = 0.0;                            ///< if it has dashes: length of the line before it, as an angle
  std::size_t vertices = 0;                         ///< vertices of its slots without those to spare
};

/// Lines and areas share their places with the workers that cut them. A slot is empty until the object is cut.
struct KeptLine : Kept {
  std::shared_ptr<LineObject> object;
  Slot slot = {}, casing = {};
  KeptOnGround ground = {};
  bool asked = false;                     ///< a job was made to cut it
  bool grown = false, unindexed = false;  ///< its places have changed since: the last job; the last pick
  LinePart part = {};
  std::unique_ptr<PickWay> picked = {};  ///< made by the first pick near it
};

/// A line that grows, as a chain of lines of few places, so that a change costs the same whatever the length.
struct KeptTrack {
  std::deque<std::uint32_t> parts;    ///< indices of lines, from the start
  std::vector<std::uint32_t> arrows;  ///< indices of points
};

struct KeptArea : Kept {
  std::shared_ptr<PolygonObject> object;
  double height_m = 0.0;
  Slot fill = {}, triangles = {}, outline = {};  ///< an extruded fill is its triangles
  KeptOnGround ground = {};
  bool asked_fill = false, asked_outline = false;
  FillFault fault = FillFault::none;
  std::unique_ptr<PickArea> picked = {};
};

struct KeptMesh : Kept {
  MeshObject object;
  glm::dvec3 place_m{0.0};
  std::size_t model = 0;  ///< index in LayerBatches::models
  Slot slot = {};
};

struct KeptLabel : Kept {
  LabelObject object;
  glm::dvec3 place_m{0.0};
  std::u32string text = {};
};

}  // namespace terrella
