#pragma once

#include <cstddef>
#include <map>
#include <memory>

#include "base/result.h"
#include "geo/objects.h"
#include "streaming/objects/gltf_accessor.h"

namespace terrella {

/// Pictures of a glTF model, PNG or JPEG. Each is decoded once, on first use. thread: one
class GltfTextures {
 public:
  GltfTextures(const tinygltf::Model& model, const GltfAccessors& accessors);

  [[nodiscard]] Result<std::shared_ptr<const MeshTexture>> get(int texture);

 private:
  Result<std::shared_ptr<const MeshTexture>> decode(int image);

  const tinygltf::Model& model_;
  const GltfAccessors& accessors_;
  std::map<int, Result<std::shared_ptr<const MeshTexture>>> decoded_;  ///< indexed by image
  std::size_t left_bytes_;
};

}  // namespace terrella
