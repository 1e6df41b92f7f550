#include "streaming/objects/vector/kml_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <pugixml.hpp>
#include <string_view>

#include "streaming/objects/vector_objects.h"
#include "streaming/raster/gdal/gdal_library.h"

namespace terrella {
namespace {

/// Name of an element without the prefix of its namespace.
std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

std::ptrdiff_t count_of(const pugi::xml_node& parent, std::string_view name) {
  return std::ranges::count_if(parent.children(), [name](const auto& child) { return local_name(child) == name; });
}

/// GDAL 3.6 follows null pointers in these two places.
class CrashCheck : public pugi::xml_tree_walker {
 public:
  [[nodiscard]] const std::string& fault() const { return fault_; }

  bool for_each(pugi::xml_node& node) override {
    const std::string_view name = local_name(node);
    if (name == "MultiGeometry" && count_of(node, "Model") > 0) {
      fault_ = "it has a Model within a MultiGeometry, which GDAL cannot read; take the Model out";
    }
    if (name == "Track" && count_of(node, "coord") > count_of(node, "when")) {
      fault_ = "it has a gx:Track with more places (gx:coord) than times (when), which GDAL cannot read; add the times";
    }
    return fault_.empty();
  }

 private:
  std::string fault_;
};

Result<std::string> read_all(const std::string& name) {
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

/// A document that is no XML counts as good if it may be a picture.
Status check_document(const std::string& name, bool may_be_picture) {
  auto text = read_all(name);
  if (!text) return text.error();
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer_inplace(text->data(), text->size());
  if (!parsed && may_be_picture) return Done{};
  if (!parsed) return Error{fmt::format("its XML is broken at byte {}: {}", parsed.offset, parsed.description())};
  CrashCheck walk;
  document.traverse(walk);
  return walk.fault().empty() ? Status(Done{}) : Error{walk.fault()};
}

}  // namespace

Status check_kml(const std::string& name, bool is_zip) {
  if (!is_zip) return check_document(name, false);
  char** const names = gdal().VSIReadDirRecursive(name.c_str());
  const std::unique_ptr<char*, decltype(gdal().CSLDestroy)> owner(names, gdal().CSLDestroy);
  for (int i = 0; i < gdal().CSLCount(names); ++i) {
    const std::string_view part = names[i];
    if (part.empty() || part.ends_with('/')) continue;
    const bool may_be_picture = !part.ends_with(".kml");
    if (const Status good = check_document(fmt::format("{}/{}", name, part), may_be_picture); !good) {
      return Error{fmt::format("{}: {}", part, good.error().message)};
    }
  }
  return Done{};
}

}  // namespace terrella
