#include "streaming/mosaic/overlay_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <utility>

#include "base/hash_mix.h"
#include "streaming/objects/vector/ground_overlays.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

Status write_whole(const fs::path& path, const std::string& bytes) {
  const fs::path part = path.string() + ".part";
  std::ofstream file(part, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code problem;
  if (file) fs::rename(part, path, problem);
  if (!file || problem) return Error{path.string() + ": cannot be written; make room there, or choose another cache"};
  return Done{};
}

/// Gives the pictures of a KML file as files.
class PictureFiles {
 public:
  PictureFiles(const KmlFile& file, fs::path unpacked) : file_(file), unpacked_(std::move(unpacked)) {}

  Result<fs::path> path_of(const std::string& picture) {
    if (!file_.is_zip()) return file_.beside(picture);
    const auto known = known_.find(picture);
    if (known != known_.end()) return known->second;
    Result<fs::path> path = unpack(picture);
    return known_.emplace(picture, std::move(path)).first->second;
  }

 private:
  Result<fs::path> unpack(const std::string& picture) {
    if (unpacked_.empty()) return Error{picture + ": there is no cache folder to unpack it into; unpack the KMZ file"};
    const std::string ending = fs::path(picture).extension().string();
    const fs::path path = unpacked_ / fmt::format("{:016x}{}", name_hash(picture), ending);
    std::error_code missing;
    const auto written = fs::last_write_time(path, missing);
    if (!missing && written > fs::last_write_time(file_.path(), missing)) return path;
    const auto bytes = file_.read(picture);
    if (!bytes) return bytes.error();
    fs::create_directories(unpacked_, missing);
    const Status done = write_whole(path, *bytes);
    if (!done) return done.error();
    return path;
  }

  const KmlFile& file_;
  const fs::path unpacked_;
  std::map<std::string, Result<fs::path>> known_;
};

}  // namespace

Result<MosaicList> read_overlay_list(const fs::path& path, const fs::path& unpacked) {
  const auto file = KmlFile::open(path);
  if (!file) return file.error();
  auto found = read_ground_overlays(*file);
  if (!found) return found.error();
  const auto is_shown = [](const GroundOverlay& overlay) { return overlay.shown; };
  const bool all = std::ranges::none_of(found->pictures, is_shown);
  MosaicList list{.name = path.stem().string(), .attribution = {}, .entries = {}, .remarks = {}};
  for (const std::string& complaint : found->complaints) list.remarks.push_back(path.string() + ": " + complaint);
  PictureFiles pictures(*file, unpacked);
  for (const GroundOverlay& overlay : found->pictures) {
    if (!all && !overlay.shown) continue;
    Result<fs::path> picture = pictures.path_of(overlay.picture);
    if (picture) {
      list.entries.push_back({.path = *std::move(picture), .corners = overlay.corners, .order = overlay.order});
    } else {
      list.remarks.push_back(fmt::format("{}: {}; it is left out", path.string(), picture.error().message));
    }
  }
  if (list.entries.empty() && !list.remarks.empty()) return Error{list.remarks.front()};
  if (list.entries.empty()) {
    return Error{path.string() + ": it has no picture (GroundOverlay); open its places, lines and areas as objects"};
  }
  return list;
}

}  // namespace terrella
