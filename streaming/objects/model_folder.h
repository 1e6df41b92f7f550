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

/// The path of something that `name` says, in a folder or below it, free of links. An error if there is no folder
/// (`folder` empty), or if `name`, or a link on the way, leads out of it.
[[nodiscard]] Result<std::filesystem::path> path_in_folder(const std::filesystem::path& folder,
                                                           const std::string& name);

/// What TinyGLTF is given of the file system: files beside the model, and zeros in place of a buffer that is not there,
/// so that what needs it alone is lost. thread: one
class ModelFolder {
 public:
  /// `document`: the model's JSON, which says how long its buffers are to be.
  ModelFolder(std::filesystem::path folder, const nlohmann::json& document);

  /// Valid as long as this is.
  tinygltf::FsCallbacks callbacks();
  /// Buffers that have zeros instead of their bytes.
  [[nodiscard]] std::set<std::size_t> missing(const tinygltf::Model& model) const;
  /// What could not be read, and why.
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
