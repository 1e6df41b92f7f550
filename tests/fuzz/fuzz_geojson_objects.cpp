#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "geo/body.h"
#include "objects/layer_objects.h"
#include "streaming/objects/geojson_objects.h"

// From bytes to what the GPU would be given.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
  const auto file = terrella::parse_geojson_objects(text, "fuzz");
  if (!file) return 0;
  terrella::LayerObjects objects(file->scene, terrella::earth().ellipsoid, 1.0, terrella::kSelectedColor);
  objects.place(terrella::cut_objects(objects.take_job(), false));
  objects.tidy();
  const terrella::LayerBatches& batches = objects.batches();
  std::size_t points = batches.spheres.groups.items().size();
  for (std::size_t k = 0; k < terrella::Batch<char>::kBuckets; ++k) {
    points += batches.markers.bucket(k).items.size();
    for (const std::uint32_t index : batches.fill_indices.bucket(k).items) {
      if (index >= batches.fill_vertices.bucket(k).items.size()) std::abort();
    }
  }
  if (points != file->scene.points.size()) std::abort();
  return 0;
}
