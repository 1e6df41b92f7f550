#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "streaming/objects/gltf_model.h"

// From bytes to triangles whose corners exist. No files beside the model are read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = terrella::parse_gltf_model(std::as_bytes(std::span(data, size)), "fuzz", {});
  if (!file) return 0;
  for (const terrella::MeshPart& part : file->model->parts) {
    if (part.indices.empty() || part.indices.size() % 3 != 0) std::abort();
    for (const std::uint32_t index : part.indices) {
      if (index >= part.vertices.size()) std::abort();
    }
    if (part.texture && part.texture->rgba.empty()) std::abort();
  }
  return 0;
}
