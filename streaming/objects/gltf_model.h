#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"

namespace terrella {

/// Limit for a model's file, for all files beside it together, and for its decoded pictures together. A longer model
/// file is refused.
inline constexpr std::size_t kMaxModelBytes = 256UL << 20;
/// A model with more nodes is refused. Nodes may be nested to any depth.
inline constexpr std::size_t kMaxModelNodes = 1'000'000;
/// Vertices and indices beyond these limits are skipped with a complaint.
inline constexpr std::size_t kMaxModelVertices = 4'000'000;
inline constexpr std::size_t kMaxModelIndices = 12'000'000;
/// Most primitives; a primitive counts once for each node that uses it.
inline constexpr std::size_t kMaxModelParts = 10'000;
inline constexpr std::size_t kMostModelComplaints = 100;

/// Drawable content of a glTF 2.0 file, and complaints about the rest. Each complaint names the file and the part.
struct ModelFile {
  std::shared_ptr<const MeshModel> model;
  std::vector<std::string> complaints;
};

/// Reads the scene of a .gltf or .glb file with TinyGLTF: triangles, strips and fans; positions, normals, the first
/// texture coordinates and colours; base colour and its texture (PNG, JPEG); node transforms. Does not support
/// animations, skins, morph targets, sparse accessors or compressed meshes. Skips faulty parts with a complaint, and
/// fails if nothing is left. Reads buffers and pictures in the file's folder. thread: any
[[nodiscard]] Result<ModelFile> read_gltf_model(const std::filesystem::path& path);
/// Reads a model from bytes. If `folder` is empty, no other files are read.
[[nodiscard]] Result<ModelFile> parse_gltf_model(std::span<const std::byte> bytes, const std::string& where,
                                                 const std::filesystem::path& folder);

}  // namespace terrella
