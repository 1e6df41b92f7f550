#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// An entry of a folder.
struct FolderEntry {
  std::string name;
  bool is_folder = false;
  bool operator==(const FolderEntry&) const = default;
};

/// True if the name ends as those of the pictures, tile sets, lists, descriptions, objects and models that the program
/// shows. thread: any
[[nodiscard]] bool has_shown_name(const std::filesystem::path& path);

/// Lists a folder without hidden entries: folders first, then files, each in alphabetical order without regard to
/// case. Without `all`, only files that has_shown_name(). The error names the folder and a cure. thread: any
[[nodiscard]] Result<std::vector<FolderEntry>> list_folder(const std::filesystem::path& folder, bool all);

}  // namespace terrella
