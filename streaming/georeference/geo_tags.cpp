#include "streaming/georeference/geo_tags.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <string_view>

#include "streaming/file_bytes.h"
#include "streaming/raster/tiff_reader.h"
#include "streaming/tiff_open.h"

namespace terrella {
namespace {

constexpr ttag_t kPixelScale = 33550;
constexpr ttag_t kTiePoints = 33922;
constexpr ttag_t kMatrix = 34264;
constexpr ttag_t kKeyDirectory = 34735;
constexpr ttag_t kKeyNumbers = 34736;
constexpr ttag_t kKeyText = 34737;
constexpr ttag_t kRpc = 50844;

/// Reads a tag that libtiff does not know. libtiff keeps such a tag with the type given by the file, which may be any.
template <class T, class Into>
Status read_tag(TIFF* tiff, ttag_t tag, TIFFDataType type, const char* name, Into& into) {
  std::uint32_t count = 0;
  const T* values = nullptr;
  const TIFFField* field = TIFFFindField(tiff, tag, TIFF_ANY);
  if (field == nullptr) return Done{};
  const bool readable = TIFFFieldDataType(field) == type && TIFFFieldReadCount(field) == TIFF_VARIABLE2;
  if (!readable) return Error{fmt::format("its tag {} ({}) has a wrong type", tag, name)};
  // libtiff leaves out a tag whose count is not plausible.
  if (TIFFGetField(tiff, tag, &count, &values) != 1 || values == nullptr) {
    return Error{fmt::format("its tag {} ({}) cannot be read", tag, name)};
  }
  into.assign(values, values + count);
  return Done{};
}

Status read_all(TIFF* tiff, GeoTags& tags) {
  const auto numbers = [tiff](ttag_t tag, const char* name, std::vector<double>& into) {
    return read_tag<double>(tiff, tag, TIFF_DOUBLE, name, into);
  };
  if (Status read = numbers(kPixelScale, "ModelPixelScale", tags.pixel_scale); !read) return read;
  if (Status read = numbers(kTiePoints, "ModelTiepoint", tags.tie_points); !read) return read;
  if (Status read = numbers(kMatrix, "ModelTransformation", tags.matrix); !read) return read;
  if (Status read = numbers(kKeyNumbers, "GeoDoubleParams", tags.key_numbers); !read) return read;
  if (Status read = read_tag<char>(tiff, kKeyText, TIFF_ASCII, "GeoAsciiParams", tags.key_text); !read) return read;
  return read_tag<std::uint16_t>(tiff, kKeyDirectory, TIFF_SHORT, "GeoKeyDirectory", tags.key_directory);
}

void read_pixels(TIFF* tiff, GeoTags& tags) {
  std::uint32_t width = 0, height = 0;
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK, bits = 1, format = SAMPLEFORMAT_UINT, samples = 1;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  tags.width_px = width;
  tags.height_px = height;
  tags.has_palette = photometric == PHOTOMETRIC_PALETTE;
  if (samples != 1) return;
  if (format == SAMPLEFORMAT_IEEEFP) tags.samples = SampleKind::floats;
  if (format == SAMPLEFORMAT_INT) tags.samples = SampleKind::int16;
  if (format == SAMPLEFORMAT_UINT && bits == 16) tags.samples = SampleKind::uint16;
}

Result<GeoTags> tags_of(TIFF* tiff) {
  GeoTags tags;
  read_pixels(tiff, tags);
  tags.has_rpc = TIFFFindField(tiff, kRpc, TIFF_ANY) != nullptr;
  if (Status read = read_all(tiff, tags); !read) return read.error();
  return tags;
}

}  // namespace

Result<std::optional<GeoTags>> read_geo_tags(const std::filesystem::path& picture) {
  const auto head = read_head(picture, 8);
  if (!head) return Error{head.error().message};
  if (!begins_as_tiff({reinterpret_cast<const char*>(head->data()), head->size()})) return std::optional<GeoTags>{};
  std::string message;
  const TiffHandle tiff = open_tiff(picture.string(), message);
  if (!tiff) return Error{fmt::format("it is not a TIFF that can be read: {}", message)};
  auto tags = tags_of(tiff.get());
  if (!tags) return tags.error();
  return std::optional(*std::move(tags));
}

Result<GeoTags> read_geo_tags(const std::shared_ptr<const ByteFile>& bytes) {
  const auto reader = TiffReader::open(bytes);
  if (!reader) return reader.error();
  return tags_of((*reader)->get());
}

Result<std::optional<GeoTags>> read_geo_tags(const PictureFile& picture) {
  if (!picture.bytes) return read_geo_tags(picture.path);
  auto tags = read_geo_tags(picture.bytes);
  if (!tags) return tags.error();
  return std::optional(*std::move(tags));
}

}  // namespace terrella
