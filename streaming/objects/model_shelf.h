#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "geo/objects.h"
#include "streaming/objects/object_style.h"

namespace terrella {

/// Most memory of all models of one file of objects together: vertices, indices and pictures.
inline constexpr std::size_t kMaxModelsBytes = 1UL << 30;
/// Most model files for one file of objects.
inline constexpr std::size_t kMaxModelFiles = 1000;

/// Models named by features. Each is read once. thread: one
class ModelShelf {
 public:
  /// Models are in or below this folder; empty: no models.
  explicit ModelShelf(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Returns null, with a complaint, if the model cannot be read. Complaints about parts of a model are made on its
  /// first use.
  [[nodiscard]] std::shared_ptr<const MeshModel> get(const std::string& name, const Complain& complain);

 private:
  std::shared_ptr<const MeshModel> read(const std::string& name, const Complain& complain);

  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const MeshModel>> models_;
  std::size_t left_bytes_ = kMaxModelsBytes;
};

}  // namespace terrella
