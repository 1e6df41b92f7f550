#include "streaming/objects/model_folder.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "streaming/file_bytes.h"
#include "streaming/objects/gltf_model.h"

namespace terrella {

Result<std::filesystem::path> path_in_folder(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
  // The system would read the name only up to the zero byte.
  const bool cut_short = name.find('\0') != std::string::npos;
  if (cut_short || folder.empty() || relative.is_absolute() || relative.empty() || *relative.begin() == "..") {
    return Error{fmt::format("{}: only files in the same folder, or in folders in it, are read", name)};
  }
  std::error_code problem;
  const std::filesystem::path root = std::filesystem::weakly_canonical(folder, problem);
  if (problem) return Error{fmt::format("{}: {}", folder.string(), problem.message())};
  const std::filesystem::path path = std::filesystem::weakly_canonical(root / relative, problem);
  if (problem) return Error{fmt::format("{}: {}", name, problem.message())};
  if (std::ranges::mismatch(root, path).in1 != root.end()) {
    return Error{fmt::format("{}: a link in it leads to {}, out of the folder; copy the file into the folder", name,
                             path.string())};
  }
  return path;
}

ModelFolder::ModelFolder(std::filesystem::path folder, const nlohmann::json& document)
    : folder_(std::move(folder)), left_bytes_(kMaxModelBytes) {
  const auto buffers = document.find("buffers");
  if (buffers == document.end() || !buffers->is_array()) return;
  for (const nlohmann::json& buffer : *buffers) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const auto length = buffer.find("byteLength");
    if (length != buffer.end() && length->is_number_unsigned()) {
      buffer_bytes_[buffer["uri"].get<std::string>()] = length->get<std::size_t>();
    }
  }
}

std::set<std::size_t> ModelFolder::missing(const tinygltf::Model& model) const {
  std::set<std::size_t> numbers;
  for (std::size_t k = 0; k < model.buffers.size(); ++k) {
    if (missing_.contains(model.buffers[k].uri)) numbers.insert(k);
  }
  return numbers;
}

tinygltf::FsCallbacks ModelFolder::callbacks() {
  tinygltf::FsCallbacks calls{};
  calls.FileExists = [](const std::string&, void*) { return true; };
  calls.ExpandFilePath = [](const std::string& path, void*) { return path; };
  calls.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error, const std::string& path, void* self) {
    return static_cast<ModelFolder*>(self)->read(path, *out, *error);
  };
  calls.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  calls.user_data = this;
  return calls;
}

Result<std::vector<std::byte>> ModelFolder::bytes_of(const std::string& name) const {
  const auto path = path_in_folder(folder_, name);
  if (!path) return path.error();
  auto bytes = read_file(*path, left_bytes_);
  if (!bytes) return Error{bytes.error().message};
  const auto wanted = buffer_bytes_.find(name);
  if (wanted == buffer_bytes_.end()) return std::move(*bytes);
  if (bytes->size() < wanted->second) {
    return Error{
        fmt::format("{}: {} bytes, fewer than the buffer's {}", path->string(), bytes->size(), wanted->second)};
  }
  bytes->resize(wanted->second);
  return std::move(*bytes);
}

bool ModelFolder::read(const std::string& name, std::vector<unsigned char>& out, std::string& error) {
  const auto bytes = bytes_of(name);
  if (bytes) {
    left_bytes_ -= std::min(left_bytes_, bytes->size());
    out.resize(bytes->size());
    if (!out.empty()) std::memcpy(out.data(), bytes->data(), out.size());
    return true;
  }
  error = bytes.error().message;
  if (complaints_.size() < kMostModelComplaints) complaints_.push_back(error);
  const auto wanted = buffer_bytes_.find(name);
  if (wanted == buffer_bytes_.end() || wanted->second == 0 || wanted->second > left_bytes_) return false;
  left_bytes_ -= wanted->second;
  missing_.insert(name);
  out.assign(wanted->second, 0);
  return true;
}

}  // namespace terrella
