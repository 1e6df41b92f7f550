#include "streaming/raster/tiff_metadata.h"

#include <algorithm>
#include <cstring>
#include <pugixml.hpp>
#include <string_view>

#include "base/number.h"

namespace terrella {
namespace {

constexpr ttag_t kGdalMetadataTag = 42112;
constexpr ttag_t kGdalNodataTag = 42113;
constexpr std::uint32_t kMaxMetadataBytes = 1U << 20;
/// Bands beyond this count as one.
constexpr int kMaxBands = 1 << 16;

/// Text of a tag that libtiff does not know, if the file gives it as text. Each of GDAL's tags is text.
std::string_view text_tag(TIFF* tiff, ttag_t tag) {
  const TIFFField* field = TIFFFindField(tiff, tag, TIFF_ANY);
  if (field == nullptr || TIFFFieldDataType(field) != TIFF_ASCII) return {};
  std::uint32_t count = 0;
  const char* text = nullptr;
  if (TIFFFieldPassCount(field) == 0) {
    if (TIFFGetField(tiff, tag, &text) != 1 || text == nullptr) return {};
    return {text, strnlen(text, kMaxMetadataBytes)};
  }
  if (TIFFGetField(tiff, tag, &count, &text) != 1 || text == nullptr) return {};
  return {text, strnlen(text, std::min(count, kMaxMetadataBytes))};
}

void read_item(const pugi::xml_node& item, TiffMetadata& metadata) {
  const std::string_view name = item.attribute("name").as_string();
  const std::string_view role = item.attribute("role").as_string();
  const auto band = static_cast<std::size_t>(std::clamp(item.attribute("sample").as_int(0), 0, kMaxBands));
  const auto of_band = [&]() -> BandMetadata& {
    if (metadata.bands.size() <= band) metadata.bands.resize(band + 1);
    return metadata.bands[band];
  };
  if (role == "unittype") of_band().unit = item.child_value();
  if (role == "description") of_band().description = item.child_value();
  const auto number = read_number(item.child_value());
  if (!number) return;
  if (role == "scale" && *number != 0.0) of_band().scale = *number;
  if (role == "offset") of_band().offset = *number;
  if (name == "STATISTICS_MINIMUM") metadata.least = std::min(metadata.least.value_or(*number), *number);
  if (name == "STATISTICS_MAXIMUM") metadata.most = std::max(metadata.most.value_or(*number), *number);
}

}  // namespace

TiffMetadata read_metadata(TiffReader& reader) {
  TiffMetadata metadata;
  metadata.nodata = read_number(text_tag(reader.get(), kGdalNodataTag));
  const std::string_view xml = text_tag(reader.get(), kGdalMetadataTag);
  pugi::xml_document document;
  if (xml.empty() || !document.load_buffer(xml.data(), xml.size())) return metadata;
  for (const pugi::xml_node& item : document.child("GDALMetadata").children("Item")) read_item(item, metadata);
  return metadata;
}

}  // namespace terrella
