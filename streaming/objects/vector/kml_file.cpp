#include "streaming/objects/vector/kml_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <pugixml.hpp>

#include "base/number.h"
#include "streaming/file_bytes.h"
#include "streaming/objects/model_folder.h"
#include "streaming/objects/vector/vector_file.h"
#include "streaming/objects/vector_objects.h"
#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// The document of a KMZ file: doc.kml, or else the first KML file.
std::string document_of(const std::vector<std::string>& names) {
  if (std::ranges::binary_search(names, "doc.kml")) return "doc.kml";
  const auto found = std::ranges::find_if(names, [](const std::string& name) { return name.ends_with(".kml"); });
  return found == names.end() ? "" : *found;
}

}  // namespace

bool is_kml_name(const fs::path& path) {
  const std::string ending = lower_extension(path);
  return ending == ".kml" || ending == ".kmz";
}

std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

Result<std::string> read_by_gdal(const std::string& name) {
  VSILFILE* const file = gdal().VSIFOpenL(name.c_str(), "rb");
  if (file == nullptr) return Error{"it cannot be opened"};
  std::string text;
  std::array<char, 1UL << 16> part{};
  std::size_t got = 0;
  while (text.size() <= kMaxVectorUnpackedBytes && (got = gdal().VSIFReadL(part.data(), 1, part.size(), file)) > 0) {
    text.append(part.data(), got);
  }
  static_cast<void>(gdal().VSIFCloseL(file));
  if (text.size() > kMaxVectorUnpackedBytes) return Error{"it is longer than it states"};
  return text;
}

std::vector<std::string> names_in_zip(const std::string& zip) {
  char** const names = gdal().VSIReadDirRecursive(zip.c_str());
  const std::unique_ptr<char*, decltype(gdal().CSLDestroy)> owner(names, gdal().CSLDestroy);
  std::vector<std::string> files;
  for (int i = 0; i < gdal().CSLCount(names); ++i) {
    const std::string_view name = names[i];
    if (!name.empty() && !name.ends_with('/')) files.emplace_back(name);
  }
  std::ranges::sort(files);
  return files;
}

Result<KmlFile> KmlFile::open(const fs::path& path) {
  const auto fault = [&](const std::string& what) { return Error{fmt::format("{}: {}", path.string(), what)}; };
  std::error_code problem;
  const fs::path whole = fs::canonical(path, problem);
  if (problem) return fault(problem.message());
  if (const auto loaded = load_gdal(); !loaded) return fault(loaded.error().message);
  const GdalMessages messages;
  if (const Status fits = check_vector_length(whole); !fits) return fault(fits.error().message);
  const bool is_zip = is_zip_name(whole);
  KmlFile file(whole, is_zip ? "/vsizip/" + whole.string() : "");
  if (is_zip) file.names_ = names_in_zip(file.zip_);
  file.document_ = is_zip ? document_of(file.names_) : whole.filename().string();
  if (file.document_.empty()) return fault("it holds no KML file");
  return file;
}

Result<fs::path> KmlFile::beside(const std::string& name) const { return path_in_folder(path_.parent_path(), name); }

Result<std::string> KmlFile::read(const std::string& name) const {
  const GdalMessages messages;
  if (is_zip()) {
    if (!std::ranges::binary_search(names_, name)) return Error{name + ": the KMZ file holds no such file"};
    Result<std::string> text = read_by_gdal(zip_ + "/" + name);
    return text ? text : Error{fmt::format("{}: {}", name, text.error().message)};
  }
  const auto file = beside(name);
  if (!file) return file.error();
  const auto bytes = read_file(*file, kMaxVectorUnpackedBytes);
  if (!bytes) return Error{bytes.error().message};
  return std::string(as_text(*bytes));
}

std::string KmlFile::resolved(const std::string& document, std::string_view reference) {
  return (fs::path(document).parent_path() / percent_decode(trimmed(reference))).lexically_normal().string();
}

}  // namespace terrella
