#include "streaming/cut/input/exif_orientation.h"

#include <libexif/exif-data.h>

#include <memory>

namespace terrella {
namespace {

struct FreeExif {
  void operator()(ExifData* data) const { exif_data_unref(data); }
};

}  // namespace

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
