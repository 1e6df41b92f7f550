#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "geo/objects.h"
#include "streaming/objects/object_style.h"

namespace terrella {

/// What the models of one file of objects may take of memory altogether: vertices, indices and pictures.
inline constexpr std::size_t kMaxModelsBytes = 1UL << 30;
/// Model files of one file of objects.
inline constexpr std::size_t kMaxModelFiles = 1000;

/// The models that features name, each read once. thread: one
class ModelShelf {
 public:
  /// Models lie in this folder or below it; empty: there are none.
  explicit ModelShelf(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// None, with a complaint, if it cannot be read; what is wrong with parts of it is complained of the first time.
  [[nodiscard]] std::shared_ptr<const MeshModel> get(const std::string& name, const Complain& complain);

 private:
  std::shared_ptr<const MeshModel> read(const std::string& name, const Complain& complain);

  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const MeshModel>> models_;
  std::size_t left_bytes_ = kMaxModelsBytes;
};

}  // namespace terrella
