#include "streaming/objects/gltf_textures.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "codecs/image.h"
#include "streaming/objects/gltf_model.h"

namespace terrella {

GltfTextures::GltfTextures(const tinygltf::Model& model, const GltfAccessors& accessors)
    : model_(model), accessors_(accessors), left_bytes_(kMaxModelBytes) {}

Result<std::shared_ptr<const MeshTexture>> GltfTextures::get(int texture) {
  if (texture < 0 || std::size_t(texture) >= model_.textures.size()) {
    return Error{fmt::format("texture {} does not exist", texture)};
  }
  const int image = model_.textures[std::size_t(texture)].source;
  if (image < 0 || std::size_t(image) >= model_.images.size()) {
    return Error{fmt::format("texture {} has no image", texture)};
  }
  const auto found = decoded_.find(image);
  return found != decoded_.end() ? found->second : decoded_.emplace(image, decode(image)).first->second;
}

Result<std::shared_ptr<const MeshTexture>> GltfTextures::decode(int image) {
  const auto fail = [image](const std::string& what) { return Error{fmt::format("image {}: {}", image, what)}; };
  const tinygltf::Image& source = model_.images[std::size_t(image)];
  std::span<const unsigned char> file = source.image;
  if (source.bufferView >= 0) {
    const auto view = accessors_.view(source.bufferView);
    if (!view) return fail("it lies in " + view.error().message);
    file = *view;
  }
  if (file.empty()) return fail("it is missing");
  auto picture = decode_image(std::as_bytes(file), {.max_bytes = left_bytes_});
  if (!picture) return fail(picture.error().message);
  left_bytes_ -= std::min(left_bytes_, picture->rgba.size());
  return std::make_shared<const MeshTexture>(
      MeshTexture{picture->width_px, picture->height_px, std::move(picture->rgba)});
}

}  // namespace terrella
