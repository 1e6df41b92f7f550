#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace tinygltf {
class Model;
}

namespace terrella {

/// Reads accessors of a glTF model and checks all bounds. thread: one
class GltfAccessors {
 public:
  /// `missing`: buffers without bytes.
  GltfAccessors(const tinygltf::Model& model, std::set<std::size_t> missing)
      : model_(model), missing_(std::move(missing)) {}

  /// Floats, or whole numbers as fractions of the largest, with `least` to `most` components. Missing components are 0,
  /// 0, 0, 1.
  [[nodiscard]] Result<std::vector<glm::vec4>> vectors(int accessor, int least, int most, std::size_t most_count) const;
  [[nodiscard]] Result<std::vector<std::uint32_t>> indices(int accessor, std::size_t most_count) const;

  /// Bytes of a buffer view.
  [[nodiscard]] Result<std::span<const unsigned char>> view(int buffer_view) const;

 private:
  struct Items {
    const unsigned char* first;
    std::size_t stride, count;
    int components, component_type;
  };
  [[nodiscard]] Result<Items> items(int accessor, std::size_t most_count) const;

  const tinygltf::Model& model_;
  std::set<std::size_t> missing_;
};

}  // namespace terrella
