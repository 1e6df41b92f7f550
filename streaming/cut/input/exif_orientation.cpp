#include "streaming/cut/input/exif_orientation.h"

#include <libexif/exif-data.h>
#include <webp/demux.h>

#include <memory>
#include <string>
#include <string_view>

namespace terrella {
namespace {

struct FreeExif {
  void operator()(ExifData* data) const { exif_data_unref(data); }
};

constexpr std::string_view kExifHead("Exif\0\0", 6);

}  // namespace

int exif_orientation_of_webp(std::span<const std::byte> file) {
  const WebPData data{reinterpret_cast<const std::uint8_t*>(file.data()), file.size()};
  const std::unique_ptr<WebPDemuxer, void (*)(WebPDemuxer*)> parts(WebPDemux(&data), WebPDemuxDelete);
  WebPChunkIterator chunk{};
  if (!parts || WebPDemuxGetChunk(parts.get(), "EXIF", 1, &chunk) == 0) return 1;
  // The chunk begins with the TIFF header; some programs write the head of a JPEG's marker before it.
  std::string block(reinterpret_cast<const char*>(chunk.chunk.bytes), chunk.chunk.size);
  WebPDemuxReleaseChunkIterator(&chunk);
  if (!block.starts_with(kExifHead)) block.insert(0, kExifHead);
  return exif_orientation(std::as_bytes(std::span(block)));
}

int exif_orientation(std::span<const std::byte> block) {
  if (block.empty()) return 1;
  const auto* bytes = reinterpret_cast<const unsigned char*>(block.data());
  const std::unique_ptr<ExifData, FreeExif> data(
      exif_data_new_from_data(bytes, static_cast<unsigned int>(block.size())));
  if (!data) return 1;
  const ExifEntry* entry = exif_content_get_entry(data->ifd[EXIF_IFD_0], EXIF_TAG_ORIENTATION);
  if (entry == nullptr || entry->format != EXIF_FORMAT_SHORT || entry->components < 1) return 1;
  const int orientation = exif_get_short(entry->data, exif_data_get_byte_order(data.get()));
  return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

}  // namespace terrella
