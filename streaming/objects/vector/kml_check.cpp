#include "streaming/objects/vector/kml_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <string_view>

#include "streaming/objects/vector/kml_file.h"

namespace terrella {
namespace {

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

/// A document that is no XML counts as good if it may be a picture.
Status check_document(const std::string& name, bool may_be_picture) {
  auto text = read_by_gdal(name);
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
  for (const std::string& part : names_in_zip(name)) {
    const bool may_be_picture = !part.ends_with(".kml");
    if (const Status good = check_document(fmt::format("{}/{}", name, part), may_be_picture); !good) {
      return Error{fmt::format("{}: {}", part, good.error().message)};
    }
  }
  return Done{};
}

}  // namespace terrella
