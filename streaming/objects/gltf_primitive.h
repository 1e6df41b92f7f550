#pragma once

#include <glm/mat4x4.hpp>

#include "base/result.h"
#include "geo/objects.h"
#include "streaming/objects/gltf_accessor.h"
#include "streaming/objects/gltf_textures.h"
#include "streaming/objects/object_style.h"

namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace terrella {

/// Vertices, indices and parts that a model may still use.
struct MeshBudget {
  std::size_t vertices, indices, parts;
};

/// State shared by all primitives of a model.
struct GltfReading {
  const tinygltf::Model& model;
  const GltfAccessors& accessors;
  GltfTextures& textures;
  MeshBudget& left;
};

/// Reads a glTF primitive as triangles in the model's frame, with its material. Skips faulty parts with a complaint;
/// fails if nothing is usable.
[[nodiscard]] Result<MeshPart> read_gltf_primitive(const GltfReading& reading, const tinygltf::Primitive& primitive,
                                                   const glm::dmat4& model_from_mesh, const Complain& complain);

}  // namespace terrella
