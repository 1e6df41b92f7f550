#include "streaming/objects/model_shelf.h"

#include <fmt/format.h>

#include <set>

#include "streaming/objects/gltf_model.h"
#include "streaming/objects/model_folder.h"

namespace terrella {
namespace {

std::size_t bytes_of_model(const MeshModel& model) {
  std::size_t bytes = 0;
  std::set<const MeshTexture*> textures;
  for (const MeshPart& part : model.parts) {
    bytes += part.vertices.size() * sizeof(MeshVertex) + part.indices.size() * sizeof(std::uint32_t);
    if (part.texture && textures.insert(part.texture.get()).second) bytes += part.texture->rgba.size();
  }
  return bytes;
}

}  // namespace

std::shared_ptr<const MeshModel> ModelShelf::get(const std::string& name, const Complain& complain) {
  const auto found = models_.find(name);
  if (found != models_.end()) {
    if (!found->second) complain(fmt::format("{}: as said, it cannot be drawn", name));
    return found->second;
  }
  if (models_.size() >= kMaxModelFiles) {
    complain(fmt::format("{}: a file names at most {} models; divide it", name, kMaxModelFiles));
    return nullptr;
  }
  return models_.emplace(name, read(name, complain)).first->second;
}

std::shared_ptr<const MeshModel> ModelShelf::read(const std::string& name, const Complain& complain) {
  const auto path = path_in_folder(folder_, name);
  if (!path) return complain(path.error().message), nullptr;
  const auto file = read_gltf_model(*path);
  if (!file) return complain(file.error().message), nullptr;
  for (const std::string& complaint : file->complaints) complain(complaint);
  const std::size_t bytes = bytes_of_model(*file->model);
  if (bytes > left_bytes_) {
    complain(fmt::format("{}: with it the models of this file would take more than {} bytes; it is left out", name,
                         kMaxModelsBytes));
    return nullptr;
  }
  left_bytes_ -= bytes;
  return file->model;
}

}  // namespace terrella
