#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "geo/body.h"
#include "objects/object_batches.h"
#include "streaming/objects/geojson_objects.h"

// From bytes to what the GPU would be given.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
  const auto file = terrella::parse_geojson_objects(text, "fuzz");
  if (!file) return 0;
  const auto batches = terrella::make_batches(file->scene, terrella::earth().ellipsoid);
  if (batches.spheres.items.size() + batches.markers.items.size() != file->scene.points.size()) std::abort();
  for (const std::uint32_t index : batches.fill_indices.items) {
    if (index >= batches.fill_vertices.size()) std::abort();
  }
  return 0;
}
