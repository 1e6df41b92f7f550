#include "streaming/raster/tiff_pyramid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "streaming/georeference/geo_tags.h"
#include "streaming/georeference/side_files.h"
#include "streaming/other_formats.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// A picture has at most 20 levels and as many masks. More directories are pages of a document.
constexpr std::size_t kMaxDirectories = 128;

Error damaged_directories(const std::string& name, const std::string& why) {
  return Error{
      fmt::format("{}: its list of pictures is damaged: {}; get it again, or rewrite it "
                  "(gdal_translate -of COG)",
                  name, why)};
}

/// The directories of one file. Those after the first that cannot be used as pictures are left out.
Result<std::vector<TiffPart>> read_directories(const std::shared_ptr<const ByteFile>& file, TiffReader& reader) {
  auto first = read_picture(reader);
  if (!first) return first.error();
  std::vector<TiffPart> parts{{.file = file, .picture = *std::move(first)}};
  std::vector<std::uint64_t> children;
  const auto add = [&] {
    auto picture = read_picture(reader);
    if (picture) parts.push_back({.file = file, .picture = *std::move(picture)});
    reader.clear_message();
  };
  std::uint16_t count = 0;
  const std::uint64_t* offsets = nullptr;
  if (TIFFGetField(reader.get(), TIFFTAG_SUBIFD, &count, &offsets) == 1 && offsets != nullptr) {
    children.assign(offsets, offsets + std::min<std::size_t>(count, kMaxDirectories));
  }
  reader.clear_message();
  while (parts.size() < kMaxDirectories && TIFFReadDirectory(reader.get()) == 1) add();
  if (!reader.message().empty()) return damaged_directories(file->name(), reader.message());
  if (parts.size() < kMaxDirectories && TIFFLastDirectory(reader.get()) == 0) {
    return damaged_directories(file->name(), "it goes round in a circle");
  }
  for (const std::uint64_t child : children) {
    if (TIFFSetSubDirectory(reader.get(), child) != 1) return damaged_directories(file->name(), reader.message());
    add();
  }
  return parts;
}

/// True if `part` shows the same as `whole`, with sides divided by one number.
bool is_smaller_version(const TiffPicture& part, const TiffPicture& whole) {
  if (part.width_px >= whole.width_px && part.height_px >= whole.height_px) return false;
  const auto width = static_cast<double>(whole.width_px);
  const auto height = static_cast<double>(whole.height_px);
  const double by = std::max(width / static_cast<double>(part.width_px), height / static_cast<double>(part.height_px));
  return std::abs(width / by - static_cast<double>(part.width_px)) <= 1.0 &&
         std::abs(height / by - static_cast<double>(part.height_px)) <= 1.0;
}

bool has_same_samples(const TiffSamples& a, const TiffSamples& b) {
  return a.colour == b.colour && a.type == b.type && a.stored_bits == b.stored_bits && a.per_pixel == b.per_pixel &&
         a.alpha == b.alpha;
}

bool is_mask(const TiffPicture& picture) {
  return picture.samples.per_pixel == 1 && picture.samples.type == SampleType::uint8 &&
         picture.samples.colour == TiffColour::gray;
}

/// Sorts directories into the levels and the masks of a pyramid.
class PyramidParts {
 public:
  explicit PyramidParts(TiffPart first) { levels_.push_back({.part = std::move(first), .mask = {}}); }

  void add(TiffPart part, bool mask_file) {
    if (part.picture.mask || mask_file) {
      if (is_mask(part.picture)) masks_.push_back(std::move(part));
      return;
    }
    const TiffPicture& whole = levels_.front().part.picture;
    const bool known = std::ranges::any_of(levels_, [&](const TiffLevel& level) {
      return level.part.picture.width_px == part.picture.width_px &&
             level.part.picture.height_px == part.picture.height_px;
    });
    if (known || !part.picture.reduced || !is_smaller_version(part.picture, whole)) return;
    if (!has_same_samples(part.picture.samples, whole.samples)) return;
    levels_.push_back({.part = std::move(part), .mask = {}});
  }

  std::vector<TiffLevel> finish() {
    for (TiffLevel& level : levels_) {
      const TiffPicture& picture = level.part.picture;
      const auto fits = std::ranges::find_if(masks_, [&](const TiffPart& mask) {
        return mask.picture.width_px == picture.width_px && mask.picture.height_px == picture.height_px;
      });
      if (fits != masks_.end()) level.mask = *fits;
    }
    const bool masked = levels_.front().mask.has_value();
    std::erase_if(levels_, [masked](const TiffLevel& level) { return level.mask.has_value() != masked; });
    std::ranges::sort(
        levels_, {}, [](const TiffLevel& level) { return level.part.picture.width_px * level.part.picture.height_px; });
    return std::move(levels_);
  }

 private:
  std::vector<TiffLevel> levels_;
  std::vector<TiffPart> masks_;
};

/// Adds the directories of a file beside the picture, if there is one.
Status add_side_file(const fs::path& path, bool mask_file, PyramidParts& parts) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return Done{};
  const auto file = open_byte_file(path);
  if (!file) return file.error();
  const auto reader = TiffReader::open(*file);
  if (!reader) return reader.error();
  auto directories = read_directories(*file, **reader);
  if (!directories) return directories.error();
  for (TiffPart& part : *directories) parts.add(std::move(part), mask_file);
  return Done{};
}

/// Refuses a picture that its Orientation tag turns. A stated place is that of the stored rows, as in GDAL, which
/// ignores the tag.
Status check_orientation(const std::shared_ptr<const ByteFile>& file, const fs::path& path,
                         const TiffPicture& picture) {
  const bool turned = picture.orientation > ORIENTATION_TOPLEFT && picture.orientation <= ORIENTATION_LEFTBOT;
  if (!turned) return Done{};
  const auto tags = read_geo_tags(file);
  const auto sides = path.empty() ? Result<std::vector<SideClaim>>(std::vector<SideClaim>()) : read_side_files(path);
  const auto places = [](const SideClaim& claim) { return claim.transform || claim.has_control_points; };
  if ((tags && tags->has_place()) || (sides && std::ranges::any_of(*sides, places))) return Done{};
  return Error{
      fmt::format("{}: its Orientation tag ({}) turns it, and a TIFF is read as it is stored; turn it upright{}: "
                  "convert {} -auto-orient upright.tif",
                  file->name(), picture.orientation, path.empty() ? ", after a download" : "",
                  path.empty() ? "IN.tif" : shell_word(path.string()))};
}

}  // namespace

namespace {

/// `path`: where the files beside the picture lie; empty: there are none.
Result<TiffPyramid> read_parts(const std::shared_ptr<const ByteFile>& file, const fs::path& path) {
  const auto reader = TiffReader::open(file);
  if (!reader) return reader.error();
  TiffPyramid pyramid{.levels = {}, .metadata = read_metadata(**reader)};
  if (!path.empty()) {
    const auto beside = aux_xml_text(path);
    if (!beside) return Error{fmt::format("{}: {}", file->name(), beside.error().message)};
    if (*beside) add_side_metadata(**beside, pyramid.metadata);
  }
  auto directories = read_directories(file, **reader);
  if (!directories) return directories.error();
  if (Status upright = check_orientation(file, path, directories->front().picture); !upright) return upright.error();
  PyramidParts parts(std::move(directories->front()));
  for (std::size_t i = 1; i < directories->size(); ++i) parts.add(std::move((*directories)[i]), false);
  for (const auto& [ending, mask_file] : {std::pair{".ovr", false}, std::pair{".msk", true}}) {
    if (path.empty()) break;
    if (Status added = add_side_file(path.string() + ending, mask_file, parts); !added) return added.error();
  }
  pyramid.levels = parts.finish();
  return pyramid;
}

}  // namespace

Result<TiffPyramid> read_pyramid(const fs::path& path) {
  const auto file = open_byte_file(path);
  if (!file) return file.error();
  return read_parts(*file, path);
}

Result<TiffPyramid> read_pyramid(const std::shared_ptr<const ByteFile>& file) { return read_parts(file, {}); }

}  // namespace terrella
