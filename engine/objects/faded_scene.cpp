#include "objects/faded_scene.h"

#include <cmath>
#include <map>
#include <memory>

namespace terrella {
namespace {

void fade(ObjectColor& color, double opacity) {
  color.alpha = static_cast<std::uint8_t>(std::lround(opacity * color.alpha));
}

std::shared_ptr<const MeshModel> faded_model(const MeshModel& model, double opacity) {
  auto copy = std::make_shared<MeshModel>(model);
  for (MeshPart& part : copy->parts) {
    part.color_linear.a *= static_cast<float>(opacity);
    part.translucent = true;
  }
  return copy;
}

}  // namespace

ObjectScene faded(ObjectScene scene, double opacity) {
  if (opacity >= 1.0) return scene;
  for (PointObject& point : scene.points) fade(point.color, opacity);
  for (LineObject& line : scene.lines) fade(line.color, opacity);
  for (LabelObject& label : scene.labels) fade(label.color, opacity);
  for (PolygonObject& polygon : scene.polygons) {
    fade(polygon.fill, opacity);
    fade(polygon.stroke, opacity);
  }
  std::map<const MeshModel*, std::shared_ptr<const MeshModel>> models;
  for (MeshObject& mesh : scene.meshes) {
    if (!mesh.model) continue;
    auto& model = models[mesh.model.get()];
    if (!model) model = faded_model(*mesh.model, opacity);
    mesh.model = model;
  }
  return scene;
}

}  // namespace terrella
