#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"

namespace pugi {
class xml_node;
}

namespace terrella {

/// True for the name of a KML or KMZ file. thread: any
[[nodiscard]] bool is_kml_name(const std::filesystem::path& path);

/// Name of an element without the prefix of its namespace.
[[nodiscard]] std::string_view local_name(const pugi::xml_node& node);

/// Reads a file by GDAL's name of it, at most kMaxVectorUnpackedBytes. GDAL is loaded. The error does not name the
/// file. Blocks. thread: any
[[nodiscard]] Result<std::string> read_by_gdal(const std::string& name);
/// Names of the files in a ZIP file, by GDAL's name of it. GDAL is loaded. Blocks. thread: any
[[nodiscard]] std::vector<std::string> names_in_zip(const std::string& zip);

/// A KML file with the files in its folder, or a KMZ file with the files in it. Names are relative to the folder or to
/// the KMZ file. thread: any
class KmlFile {
 public:
  /// Loads GDAL. The error names the file. Blocks.
  [[nodiscard]] static Result<KmlFile> open(const std::filesystem::path& path);

  /// The document that a reader begins with.
  [[nodiscard]] const std::string& document() const { return document_; }
  [[nodiscard]] bool is_zip() const { return !zip_.empty(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Reads a file. Names of a network and names that lead out are refused. The error names the file. Blocks.
  [[nodiscard]] Result<std::string> read(const std::string& name) const;
  /// The path of a file beside a KML file, which may not exist. The error names the file.
  [[nodiscard]] Result<std::filesystem::path> beside(const std::string& name) const;
  /// The name of a file to which a document refers, percent-decoded.
  [[nodiscard]] static std::string resolved(const std::string& document, std::string_view reference);

 private:
  KmlFile(std::filesystem::path path, std::string zip) : path_(std::move(path)), zip_(std::move(zip)) {}

  std::filesystem::path path_;
  std::string zip_;                 ///< GDAL's name of the KMZ file; empty: a KML file
  std::vector<std::string> names_;  ///< files of the KMZ file, in ascending order
  std::string document_;
};

}  // namespace terrella
