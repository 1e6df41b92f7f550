#include "streaming/objects/gltf_primitive.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace terrella {
namespace {

constexpr float kMostExtent_m = 1.0e8F;

int attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

bool is_usable(const glm::vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::abs(p.x) <= kMostExtent_m &&
         std::abs(p.y) <= kMostExtent_m && std::abs(p.z) <= kMostExtent_m;
}

bool is_of_triangles(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == -1 || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

/// Converts the corners of any triangle mode to separate triangles.
std::vector<std::uint32_t> as_triangles(std::vector<std::uint32_t> corners, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES || mode == -1) {
    corners.resize(corners.size() - corners.size() % 3);
    return corners;
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    triangles.insert(triangles.end(), {fan ? corners[0] : corners[k - 2], corners[k - 1], corners[k]});
  }
  return triangles;
}

/// Keeps the triangles whose corners exist and have finite positions.
void drop_broken(MeshPart& part, const Complain& complain) {
  std::size_t out_of_range = 0, nowhere = 0, kept = 0;
  for (std::size_t k = 0; k + 2 < part.indices.size(); k += 3) {
    const auto corners = {part.indices[k], part.indices[k + 1], part.indices[k + 2]};
    if (std::ranges::any_of(corners, [&part](std::uint32_t c) { return c >= part.vertices.size(); })) {
      ++out_of_range;
    } else if (!std::ranges::all_of(corners,
                                    [&part](std::uint32_t c) { return is_usable(part.vertices[c].position_m); })) {
      ++nowhere;
    } else {
      std::ranges::copy(corners, part.indices.begin() + static_cast<std::ptrdiff_t>(kept));
      kept += 3;
    }
  }
  part.indices.resize(kept);
  for (MeshVertex& vertex : part.vertices) {
    if (!is_usable(vertex.position_m)) vertex = {};
  }
  if (out_of_range > 0) {
    complain(fmt::format("{} triangles have indices out of range (of {} vertices); they are left out", out_of_range,
                         part.vertices.size()));
  }
  if (nowhere > 0)
    complain(fmt::format("{} triangles have corners that are no numbers or too far off; they are left out", nowhere));
}

void unit_normals(MeshPart& part) {
  for (MeshVertex& vertex : part.vertices) {
    const float length = glm::length(vertex.normal);
    vertex.normal = std::isfinite(length) && length > 0.0F ? vertex.normal / length : glm::vec3(0.0F);
  }
}

/// Reads an optional attribute of a primitive.
template <class Set>
bool read_optional(const tinygltf::Primitive& primitive, const char* name, int least, int most, MeshPart& part,
                   const GltfAccessors& accessors, const Complain& complain, const Set& set) {
  const int accessor = attribute(primitive, name);
  if (accessor < 0) return false;
  const auto values = accessors.vectors(accessor, least, most, part.vertices.size());
  if (!values || values->size() != part.vertices.size()) {
    complain(
        fmt::format("{}: {}; it is drawn without", name, values ? "not as many as positions" : values.error().message));
    return false;
  }
  for (std::size_t k = 0; k < values->size(); ++k) set(part.vertices[k], (*values)[k]);
  return true;
}

void set_material(const GltfReading& reading, const tinygltf::Primitive& primitive, MeshPart& part,
                  const Complain& complain) {
  const tinygltf::Model& model = reading.model;
  if (primitive.material < 0) return;
  if (std::size_t(primitive.material) >= model.materials.size()) {
    return complain(fmt::format("material {} does not exist", primitive.material));
  }
  const tinygltf::Material& material = model.materials[std::size_t(primitive.material)];
  const auto& factor = material.pbrMetallicRoughness.baseColorFactor;
  for (int c = 0; c < 4 && std::size_t(c) < factor.size(); ++c) {
    part.color_linear[c] = static_cast<float>(std::clamp(factor[std::size_t(c)], 0.0, 1.0));
  }
  part.translucent = material.alphaMode == "BLEND";
  if (material.alphaMode == "MASK") part.cutoff = static_cast<float>(std::clamp(material.alphaCutoff, 0.0, 1.0));
  const tinygltf::TextureInfo& texture = material.pbrMetallicRoughness.baseColorTexture;
  if (texture.index < 0) return;
  auto picture = reading.textures.get(texture.index);
  if (!picture) return complain(picture.error().message + "; it is drawn without");
  part.texture = std::move(*picture);
}

/// Reads the triangles. Charges the budget even if the primitive then proves useless, which bounds the total work.
Result<MeshPart> read_triangles(const GltfReading& reading, const tinygltf::Primitive& primitive,
                                const glm::dmat4& model_from_mesh) {
  if (!is_of_triangles(primitive.mode)) return Error{"it is of points or lines, which are not drawn"};
  const auto positions = reading.accessors.vectors(attribute(primitive, "POSITION"), 3, 3, reading.left.vertices);
  if (!positions) return Error{"POSITION: " + positions.error().message};
  MeshPart part;
  part.vertices.resize(positions->size());
  reading.left.vertices -= part.vertices.size();
  for (std::size_t k = 0; k < positions->size(); ++k) {
    part.vertices[k].position_m = glm::vec3(model_from_mesh * glm::dvec4((*positions)[k]));
  }
  std::vector<std::uint32_t> corners;
  const std::size_t most_corners = reading.left.indices / 3;  // a strip gives three indices for each corner
  if (primitive.indices >= 0) {
    auto read = reading.accessors.indices(primitive.indices, most_corners);
    if (!read) return Error{"indices: " + read.error().message};
    corners = std::move(*read);
  } else {
    if (part.vertices.size() > most_corners) return Error{"more triangles than are left to the model"};
    for (std::uint32_t k = 0; k < part.vertices.size(); ++k) corners.push_back(k);
  }
  part.indices = as_triangles(std::move(corners), primitive.mode);
  reading.left.indices -= part.indices.size();
  return part;
}

}  // namespace

Result<MeshPart> read_gltf_primitive(const GltfReading& reading, const tinygltf::Primitive& primitive,
                                     const glm::dmat4& model_from_mesh, const Complain& complain) {
  auto read = read_triangles(reading, primitive, model_from_mesh);
  if (!read) return read.error();
  MeshPart part = std::move(*read);
  drop_broken(part, complain);
  if (part.indices.empty()) return Error{"no triangle of it can be drawn"};
  const GltfAccessors& accessors = reading.accessors;
  const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(model_from_mesh)));
  read_optional(
      primitive, "NORMAL", 3, 3, part, accessors, complain,
      [&turn](MeshVertex& vertex, const glm::vec4& value) { vertex.normal = glm::vec3(turn * glm::dvec3(value)); });
  unit_normals(part);
  read_optional(primitive, "TEXCOORD_0", 2, 2, part, accessors, complain,
                [](MeshVertex& vertex, const glm::vec4& value) {
                  if (std::isfinite(value.x) && std::isfinite(value.y)) vertex.uv = {value.x, value.y};
                });
  read_optional(primitive, "COLOR_0", 3, 4, part, accessors, complain, [](MeshVertex& vertex, const glm::vec4& value) {
    for (int c = 0; c < 4; ++c) vertex.color_linear[c] = value[c] >= 0.0F ? std::min(value[c], 1.0F) : 0.0F;
  });
  set_material(reading, primitive, part, complain);
  return part;
}

}  // namespace terrella
