#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/objects.h"
#include "streaming/objects/object_style.h"

namespace terrella {

/// Most bytes of an icon's file.
inline constexpr std::size_t kMostIconBytes = 4UL << 20;

/// Icons named by features: picture files, or pictures in data: URIs. Each is read once. thread: one
class IconShelf {
 public:
  /// Reads a picture's file. The error names the file.
  using ReadPicture = std::function<Result<std::vector<std::byte>>(const std::string& name)>;

  explicit IconShelf(ReadPicture read_file) : read_file_(std::move(read_file)) {}

  /// Returns null, with a complaint, if the icon cannot be read.
  [[nodiscard]] std::shared_ptr<const IconImage> get(const std::string& name, const Complain& complain);

 private:
  [[nodiscard]] Result<std::shared_ptr<const IconImage>> read(const std::string& name) const;

  ReadPicture read_file_;
  std::map<std::string, std::shared_ptr<const IconImage>> icons_;
};

}  // namespace terrella
