#include "streaming/raster/gdal/vrt_sources.h"

#include <fmt/format.h>

#include <filesystem>
#include <pugixml.hpp>
#include <set>
#include <string_view>

#include "base/number.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostVrtBytes = 16U << 20;
/// First bytes of a file that tell if it is a description.
constexpr std::size_t kVrtHeadBytes = 4096;
/// Descriptions that describe descriptions end here.
constexpr int kMostDepth = 8;

bool names_source(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  return name == "SourceFilename" || name == "SourceDataset" || name == "OverviewFilename" || name == "Filename" ||
         name == "RefDataset";
}

/// Checks the sources of one description, and of those that it names.
class SourceCheck : public pugi::xml_tree_walker {
 public:
  SourceCheck(fs::path description, std::set<fs::path>& seen, int depth)
      : description_(std::move(description)), seen_(seen), depth_(depth) {}
  [[nodiscard]] const std::string& fault() const { return fault_; }

  bool for_each(pugi::xml_node& node) override {
    if (std::string_view(node.name()) == "VRTDataset" || !names_source(node)) return true;
    check(node.child_value(), node.attribute("relativeToVRT").as_int(0) != 0);
    return fault_.empty();
  }

  /// `seen`: descriptions that were checked.
  static Status check_file(const fs::path& path, std::set<fs::path>& seen, int depth) {
    const auto head = read_head(path, kVrtHeadBytes);
    if (!head) return Error{head.error().message};
    if (as_text(*head).find("<VRTDataset") == std::string_view::npos) return Done{};
    const auto bytes = read_head(path, kMostVrtBytes);
    if (!bytes) return Error{bytes.error().message};
    const std::string_view text = as_text(*bytes);
    if (depth > kMostDepth) return Error{path.string() + ": its description names descriptions that name descriptions"};
    pugi::xml_document document;
    if (!document.load_buffer(text.data(), text.size())) {
      return Error{path.string() + ": is a VRT that cannot be read as XML; make it anew (gdalbuildvrt)"};
    }
    SourceCheck walk(path, seen, depth);
    document.traverse(walk);
    if (walk.fault().empty()) return Done{};
    return Error{walk.fault()};
  }

 private:
  void check(std::string_view name, bool is_relative) {
    std::error_code failed;
    const fs::path folder = fs::weakly_canonical(fs::absolute(description_, failed).parent_path(), failed);
    const bool is_plain = !name.empty() && name.find_first_of(":<>?*|\"") == std::string_view::npos;
    const fs::path named(name);
    const fs::path source = fs::weakly_canonical(is_relative ? folder / named : fs::absolute(named, failed), failed);
    const fs::path inside = source.lexically_relative(folder);
    const bool is_inside = !failed && !inside.empty() && *inside.begin() != "..";
    if (!is_plain || !is_inside) {
      fault_ = fmt::format(
          "{}: it names the source {}, which is no file in its folder, and a VRT may read only such; put the file "
          "there, or make one raster of it (gdal_translate -of COG)",
          description_.string(), in_quotes(name));
      return;
    }
    if (!seen_.insert(source).second) return;
    if (const Status checked = check_file(source, seen_, depth_ + 1); !checked && fs::exists(source, failed)) {
      fault_ = checked.error().message;
    }
  }

  fs::path description_;
  std::set<fs::path>& seen_;
  int depth_;
  std::string fault_;
};

}  // namespace

Status check_vrt_sources(const std::string& path) {
  std::set<fs::path> seen;
  return SourceCheck::check_file(path, seen, 0);
}

}  // namespace terrella
