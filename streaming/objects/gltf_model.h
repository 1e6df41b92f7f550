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

/// A model's file that is longer is refused; of the files beside it no more is read altogether, and what its pictures
/// are decoded to is no more either.
inline constexpr std::size_t kMaxModelBytes = 256UL << 20;
/// A model with more nodes is refused. They may be nested as deep as they are many.
inline constexpr std::size_t kMaxModelNodes = 1'000'000;
/// What is more is left out with a complaint.
inline constexpr std::size_t kMaxModelVertices = 4'000'000;
inline constexpr std::size_t kMaxModelIndices = 12'000'000;
/// Primitives, each as often as nodes have it.
inline constexpr std::size_t kMaxModelParts = 10'000;
inline constexpr std::size_t kMostModelComplaints = 100;

/// What a glTF 2.0 file holds that can be drawn, and what in it cannot, each with the file and the part of it.
struct ModelFile {
  std::shared_ptr<const MeshModel> model;
  std::vector<std::string> complaints;
};

/// Reads the scene of a .gltf or .glb file with TinyGLTF: triangles, their strips and fans; positions, normals, the
/// first texture coordinates and colours; base colour and its texture (PNG, JPEG); transforms of nodes. No animations,
/// skins, morph targets, sparse accessors or compressed meshes. What is wrong is left out and complained of. Fails if
/// nothing is left. Buffers and pictures are looked for in the file's folder. thread: any
[[nodiscard]] Result<ModelFile> read_gltf_model(const std::filesystem::path& path);
/// The same of a file's bytes; `folder` empty: nothing beside them is read.
[[nodiscard]] Result<ModelFile> parse_gltf_model(std::span<const std::byte> bytes, const std::string& where,
                                                 const std::filesystem::path& folder);

}  // namespace terrella
