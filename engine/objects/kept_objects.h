#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "geo/split_position.h"
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
  bool visible = true, selected = false, removed = false;
};

struct KeptPoint : Kept {
  PointObject object;
  glm::dvec3 place_m{0.0};
  Slot slot = {};           ///< slot of a disc or an icon
  std::uint32_t image = 0;  ///< index of an icon's picture in LayerBatches::icon_images
};

/// The place of a line or an area on the ground, which has no slots.
struct KeptOnGround {
  bool lies = false;  ///< lies_on_ground() when it was cut
  std::shared_ptr<const GroundShape> shape = {};
  std::uint32_t place = GroundBatch::kNone;  ///< in LayerBatches::ground
};

/// Lines and areas share their places with the workers that cut them. A slot is empty until the object is cut.
struct KeptLine : Kept {
  std::shared_ptr<LineObject> object;
  Slot slot = {};
  KeptOnGround ground = {};
  bool asked = false;                    ///< a job was made to cut it
  std::unique_ptr<PickWay> picked = {};  ///< made by the first pick near it
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
