#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"

namespace tinygltf {
class Model;
struct FsCallbacks;
}  // namespace tinygltf

namespace terrella {

/// Resolves `name` to a path in or below a folder, free of links. Fails if there is no folder (`folder` empty), or if
/// `name` or a link on the way leads out of it.
[[nodiscard]] Result<std::filesystem::path> path_in_folder(const std::filesystem::path& folder,
                                                           const std::string& name);

/// File system access for TinyGLTF: files beside the model. A missing buffer is replaced by zeros, so that only parts
/// that need it are lost. thread: one
class ModelFolder {
 public:
  /// `document`: JSON of the model, which gives the lengths of its buffers.
  ModelFolder(std::filesystem::path folder, const nlohmann::json& document);

  /// Valid during the life of this object.
  tinygltf::FsCallbacks callbacks();
  /// Indices of buffers that contain zeros instead of their bytes.
  [[nodiscard]] std::set<std::size_t> missing(const tinygltf::Model& model) const;
  /// Files that could not be read, and why.
  [[nodiscard]] const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  bool read(const std::string& name, std::vector<unsigned char>& out, std::string& error);
  Result<std::vector<std::byte>> bytes_of(const std::string& name) const;

  std::filesystem::path folder_;
  std::vector<std::string> complaints_;
  std::map<std::string, std::size_t> buffer_bytes_;
  std::set<std::string> missing_;
  std::size_t left_bytes_;
};

}  // namespace terrella
