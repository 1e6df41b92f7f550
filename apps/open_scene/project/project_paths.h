#pragma once

#include <filesystem>
#include <string>

// Paths in a project. thread: any
namespace terrella {

/// True for a file name that ends in .terrella.
[[nodiscard]] bool is_project(const std::string& source);
/// True unless the text is an address ("https://...") or a name of a driver of GDAL's ("NETCDF:file:variable").
[[nodiscard]] bool is_path(const std::string& source);
/// Returns a path seen from `folder`, or an absolute path if `folder` is empty. Leaves other texts as they are.
[[nodiscard]] std::string seen_from(const std::string& source, const std::filesystem::path& folder);
/// Returns a path that is seen from `folder` as one seen from the working folder. Leaves other texts as they are.
[[nodiscard]] std::string found_from(const std::string& source, const std::filesystem::path& folder);

}  // namespace terrella
