#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace terrella::test {

/// A binary glTF file in the making: change what is to be wrong, then ask for its bytes.
struct ModelFixture {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  std::string buffer;

  template <class T>
  int add_accessor(const std::vector<T>& values, int component_type, const char* type, std::size_t count) {
    const std::size_t bytes = values.size() * sizeof(T);
    const std::size_t at = buffer.size();
    buffer.resize((at + bytes + 3) / 4 * 4);
    std::memcpy(buffer.data() + at, values.data(), bytes);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", at}, {"byteLength", bytes}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component_type},
                                 {"type", type},
                                 {"count", count}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  /// The JSON with the buffer's length, as a .gltf file has it.
  [[nodiscard]] nlohmann::json document(const std::string& uri = "") const {
    nlohmann::json whole = json;
    whole["buffers"] = {{{"byteLength", buffer.size()}}};
    if (!uri.empty()) whole["buffers"][0]["uri"] = uri;
    return whole;
  }

  /// As a .glb file.
  [[nodiscard]] std::string bytes() const {
    std::string text = document().dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    const auto add = [&file](std::size_t value) {
      const auto number = static_cast<std::uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    add(2);
    add(12 + 8 + text.size() + 8 + buffer.size());
    add(text.size());
    file += "JSON" + text;
    add(buffer.size());
    return file + std::string("BIN\0", 4) + buffer;
  }
};

/// A box from `low` to `high` in metres, of one colour, its 36 indices of type Index.
template <class Index = std::uint16_t>
ModelFixture box_model(std::array<float, 3> low, std::array<float, 3> high, std::array<double, 4> color_linear) {
  std::vector<float> positions;
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      positions.push_back((corner >> axis & 1U) != 0 ? high[axis] : low[axis]);
    }
  }
  const std::vector<Index> indices{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  constexpr int kFloat = 5126, kByte = 5121, kShort = 5123, kInt = 5125;
  ModelFixture box;
  const int position = box.add_accessor(positions, kFloat, "VEC3", 8);
  const int index =
      box.add_accessor(indices, sizeof(Index) == 1 ? kByte : (sizeof(Index) == 2 ? kShort : kInt), "SCALAR", 36);
  box.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", color_linear}}}}};
  box.json["meshes"] = {
      {{"name", "box"},
       {"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}, {"material", 0}}}}}};
  box.json["nodes"] = {{{"mesh", 0}}};
  box.json["scenes"] = {{{"nodes", {0}}}};
  return box;
}

}  // namespace terrella::test
