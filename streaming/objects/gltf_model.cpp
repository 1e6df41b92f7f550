#include "streaming/objects/gltf_model.h"

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <set>
#include <span>
#include <string_view>

#include "base/result.h"
#include "streaming/file_bytes.h"
#include "streaming/json_text.h"
#include "streaming/objects/gltf_primitive.h"
#include "streaming/objects/gltf_textures.h"
#include "streaming/objects/model_folder.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr std::size_t kMostGltfPieces = 4'000'000;

/// Text of a binary file's first chunk.
Result<std::string_view> first_chunk(std::string_view file) {
  constexpr std::size_t kHeader = 20, kLengthAt = 12, kChunkHeader = 8;
  const auto length_at = [file](std::size_t offset) {
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + offset, sizeof length);
    return std::size_t(length);
  };
  if (file.size() < kHeader) return Error{"a binary glTF file of fewer than 20 bytes"};
  const std::size_t length = length_at(kLengthAt);
  if (length > file.size() - kHeader) return Error{"a binary glTF file that breaks off in its JSON"};
  const std::size_t next = kHeader + length;
  if (file.size() - next >= kChunkHeader && length_at(next) > file.size() - next - kChunkHeader) {
    return Error{"a binary glTF file that breaks off in its buffer"};
  }
  return file.substr(kHeader, length);
}

/// Parses the JSON of a glTF file; a binary file (.glb) has it in its first chunk. Refuses JSON that would crash
/// TinyGLTF: deeper than kJsonLimits, more than 4 million pieces (JsonBuilder), or chunks beyond the end of the file.
/// Also refuses more nodes than kMaxModelNodes.
Result<json> gltf_json(std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("glTF")) {
    const auto chunk = first_chunk(text);
    if (!chunk) return chunk.error();
    text = *chunk;
  }
  Result<json> document = parse_json(text, {.depth = kJsonLimits.depth, .pieces = kMostGltfPieces});
  if (!document) return Error{document.error().message + "; a .gltf or .glb file is needed"};
  if (!document->is_object() || !document->contains("asset")) return Error{"JSON, but no glTF: it has no \"asset\""};
  const auto nodes = document->find("nodes");
  if (nodes != document->end() && nodes->size() > kMaxModelNodes) {
    return Error{
        fmt::format("it has {} nodes, more than the {} that are read; divide it", nodes->size(), kMaxModelNodes)};
  }
  return document;
}

/// Keeps a picture's file undecoded until it is needed. Pictures in buffers stay there, because TinyGLTF does not check
/// that they end inside the buffer.
bool keep_picture(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  image->image.clear();
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

glm::dmat4 transform_of(const tinygltf::Node& node) {
  glm::dmat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] = node.matrix[std::size_t(k)];
    return matrix;
  }
  if (node.translation.size() == 3) matrix[3] = {node.translation[0], node.translation[1], node.translation[2], 1.0};
  if (node.rotation.size() == 4) {
    matrix *= glm::mat4_cast(
        glm::normalize(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])));
  }
  if (node.scale.size() == 3) {
    for (int k = 0; k < 3; ++k) matrix[k] *= node.scale[std::size_t(k)];
  }
  return matrix;
}

/// Walks the nodes of a scene and collects the triangles of their meshes.
class SceneTaker {
 public:
  SceneTaker(const tinygltf::Model& model, std::set<std::size_t> missing, const std::string& where,
             std::vector<std::string>& complaints)
      : model_(model),
        accessors_(model, std::move(missing)),
        textures_(model, accessors_),
        where_(where),
        complaints_(complaints) {}

  MeshModel take() {
    struct Task {
      int node;
      glm::dmat4 model_from_parent;
    };
    std::vector<Task> tasks;
    for (const int root : roots()) tasks.push_back({root, glm::dmat4(1.0)});
    std::set<int> seen;
    while (!tasks.empty() && left_.parts > 0) {
      const Task task = tasks.back();
      tasks.pop_back();
      if (task.node < 0 || std::size_t(task.node) >= model_.nodes.size()) {
        complain(fmt::format("node {} does not exist", task.node));
      } else if (!seen.insert(task.node).second) {
        complain(fmt::format("node {} comes again among the nodes; a scene is a tree", task.node));
      } else {
        const tinygltf::Node& node = model_.nodes[std::size_t(task.node)];
        const glm::dmat4 model_from_node = task.model_from_parent * transform_of(node);
        if (node.mesh >= 0) take_mesh(node.mesh, model_from_node);
        for (const int child : node.children) tasks.push_back({child, model_from_node});
      }
    }
    return std::move(taken_);
  }

 private:
  /// Root nodes of the file's default scene, or of its first scene. Without a scene, all nodes that have no parent.
  [[nodiscard]] std::vector<int> roots() const {
    const auto scene = std::size_t(std::max(model_.defaultScene, 0));
    if (scene < model_.scenes.size()) return model_.scenes[scene].nodes;
    std::set<int> children;
    for (const tinygltf::Node& node : model_.nodes) children.insert(node.children.begin(), node.children.end());
    std::vector<int> nodes;
    for (int k = 0; std::size_t(k) < model_.nodes.size(); ++k) {
      if (!children.contains(k)) nodes.push_back(k);
    }
    return nodes;
  }

  void take_mesh(int number, const glm::dmat4& model_from_mesh) {
    if (std::size_t(number) >= model_.meshes.size()) return complain(fmt::format("mesh {} does not exist", number));
    const tinygltf::Mesh& mesh = model_.meshes[std::size_t(number)];
    for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
      if (left_.parts == 0) return;
      const Complain of_primitive = [&](const std::string& what) {
        complain(fmt::format("mesh {}{}, primitive {}: {}", number,
                             mesh.name.empty() ? "" : fmt::format(" (\"{}\")", mesh.name), k, what));
      };
      if (--left_.parts == 0)
        of_primitive(fmt::format("a model has at most {}; the others are left out", kMaxModelParts));
      auto part = read_gltf_primitive({model_, accessors_, textures_, left_}, mesh.primitives[k], model_from_mesh,
                                      of_primitive);
      if (part) {
        taken_.parts.push_back(std::move(*part));
      } else {
        of_primitive(part.error().message + "; it is left out");
      }
    }
  }

  void complain(const std::string& what) {
    if (complaints_.size() < kMostModelComplaints) complaints_.push_back(fmt::format("{}: {}", where_, what));
  }

  const tinygltf::Model& model_;
  GltfAccessors accessors_;
  GltfTextures textures_;
  const std::string& where_;
  std::vector<std::string>& complaints_;
  MeshBudget left_{kMaxModelVertices, kMaxModelIndices, kMaxModelParts};
  MeshModel taken_;
};

std::string in_one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

bool load(tinygltf::Model& model, std::span<const std::byte> bytes, ModelFolder& folder, std::string& error) {
  tinygltf::TinyGLTF reader;
  std::string warning;
  reader.SetFsCallbacks(folder.callbacks());
  reader.SetImageLoader(&keep_picture, nullptr);
  const auto size = static_cast<unsigned>(bytes.size());
  try {
    if (size >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
      return reader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                         size, "");
    }
    return reader.LoadASCIIFromString(&model, &error, &warning, reinterpret_cast<const char*>(bytes.data()), size, "");
  } catch (const std::exception& problem) {
    error = problem.what();
    return false;
  }
}

}  // namespace

Result<ModelFile> parse_gltf_model(std::span<const std::byte> bytes, const std::string& where,
                                   const std::filesystem::path& folder) {
  if (bytes.size() > kMaxModelBytes) {
    return Error{fmt::format("{}: {} bytes are more than the {} that are read", where, bytes.size(), kMaxModelBytes)};
  }
  const Result<nlohmann::json> document = gltf_json(bytes);
  if (!document) return Error{fmt::format("{}: {}", where, document.error().message)};
  ModelFile file;
  ModelFolder files(folder, *document);
  tinygltf::Model model;
  std::string error;
  if (!load(model, bytes, files, error)) return Error{fmt::format("{}: {}", where, in_one_line(error))};
  for (const std::string& complaint : files.complaints()) {
    file.complaints.push_back(fmt::format("{}: {}", where, complaint));
  }
  MeshModel taken = SceneTaker(model, files.missing(model), where, file.complaints).take();
  if (taken.parts.empty()) {
    return Error{fmt::format("{}: nothing in it can be drawn{}", where,
                             file.complaints.empty() ? "" : "; " + file.complaints.front())};
  }
  file.model = std::make_shared<const MeshModel>(std::move(taken));
  return file;
}

Result<ModelFile> read_gltf_model(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxModelBytes);
  if (!bytes) return Error{bytes.error().message};
  return parse_gltf_model(*bytes, path.string(), path.parent_path().empty() ? "." : path.parent_path());
}

}  // namespace terrella
