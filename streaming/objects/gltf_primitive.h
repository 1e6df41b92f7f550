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

/// What a model may still take of vertices and indices.
struct MeshBudget {
  std::size_t vertices, indices, parts;
};

/// What primitives of one model are read with.
struct GltfReading {
  const tinygltf::Model& model;
  const GltfAccessors& accessors;
  GltfTextures& textures;
  MeshBudget& left;
};

/// A glTF primitive as triangles in the model's frame, with its material. What is wrong with parts of it is complained
/// of, and the rest is taken; fails if nothing can be.
[[nodiscard]] Result<MeshPart> read_gltf_primitive(const GltfReading& reading, const tinygltf::Primitive& primitive,
                                                   const glm::dmat4& model_from_mesh, const Complain& complain);

}  // namespace terrella
