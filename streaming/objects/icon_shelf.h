#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "base/result.h"
#include "geo/objects.h"
#include "streaming/objects/object_style.h"

namespace terrella {

/// Icons named by features: picture files, or pictures in data: URIs. Each is read once. thread: one
class IconShelf {
 public:
  /// Files are in or below this folder; empty: no files.
  explicit IconShelf(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Returns null, with a complaint, if the icon cannot be read.
  [[nodiscard]] std::shared_ptr<const IconImage> get(const std::string& name, const Complain& complain);

 private:
  [[nodiscard]] Result<std::shared_ptr<const IconImage>> read(const std::string& name) const;

  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const IconImage>> icons_;
};

}  // namespace terrella
