#include "streaming/objects/gltf_accessor.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstring>

namespace terrella {
namespace {

template <class T>
T value_at(const unsigned char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

float component(const unsigned char* from, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return float(*from) / 255.0F;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return float(value_at<std::uint16_t>(from)) / 65535.0F;
    default:
      return value_at<float>(from);
  }
}

}  // namespace

Result<std::span<const unsigned char>> GltfAccessors::view(int buffer_view) const {
  if (buffer_view < 0 || std::size_t(buffer_view) >= model_.bufferViews.size()) {
    return Error{fmt::format("buffer view {}, which does not exist", buffer_view)};
  }
  const tinygltf::BufferView& view = model_.bufferViews[std::size_t(buffer_view)];
  if (view.buffer < 0 || std::size_t(view.buffer) >= model_.buffers.size()) {
    return Error{fmt::format("buffer {}, which does not exist", view.buffer)};
  }
  if (missing_.contains(std::size_t(view.buffer)))
    return Error{fmt::format("buffer {}, which is missing", view.buffer)};
  const std::vector<unsigned char>& data = model_.buffers[std::size_t(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    return Error{fmt::format("buffer view {}, which runs over its buffer's {} bytes", buffer_view, data.size())};
  }
  return std::span(data).subspan(view.byteOffset, view.byteLength);
}

Result<GltfAccessors::Items> GltfAccessors::items(int accessor, std::size_t most_count) const {
  const auto fail = [accessor](const std::string& what) {
    return Error{fmt::format("accessor {} {}", accessor, what)};
  };
  if (accessor < 0 || std::size_t(accessor) >= model_.accessors.size()) return fail("does not exist");
  const tinygltf::Accessor& a = model_.accessors[std::size_t(accessor)];
  if (a.sparse.isSparse) return fail("is sparse, which is not read");
  const auto found = view(a.bufferView);
  if (!found) return fail("lies in " + found.error().message);
  const int components = tinygltf::GetNumComponentsInType(std::uint32_t(a.type));
  const int bytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(a.componentType));
  if (components < 1 || components > 4 || bytes < 1) return fail("is of no type that is read");
  const std::size_t item = std::size_t(components) * std::size_t(bytes), length = found->size();
  const std::size_t said = model_.bufferViews[std::size_t(a.bufferView)].byteStride, stride = said == 0 ? item : said;
  if (a.count > most_count)
    return fail(fmt::format("has {} items, more than the {} that are left", a.count, most_count));
  if (a.count == 0 || stride < item) return fail("is empty or its items overlap");
  if (a.byteOffset > length || item > length - a.byteOffset ||
      (a.count - 1) > (length - a.byteOffset - item) / stride) {
    return fail(fmt::format("runs over buffer view {}: {} items of {} bytes from byte {}, of {}", a.bufferView, a.count,
                            stride, a.byteOffset, length));
  }
  return Items{found->data() + a.byteOffset, stride, a.count, components, a.componentType};
}

Result<std::vector<glm::vec4>> GltfAccessors::vectors(int accessor, int least, int most, std::size_t most_count) const {
  const auto found = items(accessor, most_count);
  if (!found) return found.error();
  const bool whole = found->component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                     found->component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (found->components < least || found->components > most ||
      (!whole && found->component_type != TINYGLTF_COMPONENT_TYPE_FLOAT)) {
    return Error{fmt::format("accessor {} is not of the type that is needed here", accessor)};
  }
  const auto bytes = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(found->component_type)));
  std::vector<glm::vec4> values(found->count, glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
  for (std::size_t k = 0; k < found->count; ++k) {
    for (int c = 0; c < found->components; ++c) {
      values[k][c] = component(found->first + k * found->stride + std::size_t(c) * bytes, found->component_type);
    }
  }
  return values;
}

Result<std::vector<std::uint32_t>> GltfAccessors::indices(int accessor, std::size_t most_count) const {
  const auto found = items(accessor, most_count);
  if (!found) return found.error();
  const int type = found->component_type;
  if (found->components != 1 ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
    return Error{fmt::format("accessor {} is not of indices", accessor)};
  }
  std::vector<std::uint32_t> values(found->count);
  for (std::size_t k = 0; k < found->count; ++k) {
    const unsigned char* from = found->first + k * found->stride;
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) {
      values[k] = *from;
    } else if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
      values[k] = value_at<std::uint16_t>(from);
    } else {
      values[k] = value_at<std::uint32_t>(from);
    }
  }
  return values;
}

}  // namespace terrella
