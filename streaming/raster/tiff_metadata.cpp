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

void set_statistics(std::string_view name, double number, TiffMetadata& metadata) {
  if (name == "STATISTICS_MINIMUM") metadata.least = std::min(metadata.least.value_or(number), number);
  if (name == "STATISTICS_MAXIMUM") metadata.most = std::max(metadata.most.value_or(number), number);
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
  if (role == "colorinterp") of_band().colour = item.child_value();
  const auto number = read_number(item.child_value());
  if (!number) return;
  if (role == "scale" && *number != 0.0) of_band().scale = *number;
  if (role == "offset") of_band().offset = *number;
  set_statistics(name, *number, metadata);
}

void read_side_band(const pugi::xml_node& node, TiffMetadata& metadata) {
  const auto index = static_cast<std::size_t>(std::clamp(node.attribute("band").as_int(1), 1, kMaxBands) - 1);
  if (metadata.bands.size() <= index) metadata.bands.resize(index + 1);
  BandMetadata& band = metadata.bands[index];
  const auto number = [&node](const char* name) { return read_number(node.child_value(name)); };
  if (const auto nodata = number("NoDataValue"); nodata && index == 0) metadata.nodata = nodata;
  if (band.scale == 1.0 && band.offset == 0.0) {
    if (const auto scale = number("Scale"); scale && *scale != 0.0) band.scale = *scale;
    band.offset = number("Offset").value_or(0.0);
  }
  if (node.child("UnitType")) band.unit = node.child_value("UnitType");
  if (node.child("ColorInterp")) band.colour = node.child_value("ColorInterp");
  if (node.child("Description")) band.description = node.child_value("Description");
  for (const pugi::xml_node& item : node.child("Metadata").children("MDI")) {
    if (const auto value = read_number(item.child_value())) {
      set_statistics(item.attribute("key").as_string(), *value, metadata);
    }
  }
}

}  // namespace

void add_side_metadata(const std::string& xml, TiffMetadata& metadata) {
  pugi::xml_document document;
  if (!document.load_buffer(xml.data(), xml.size())) return;
  for (const pugi::xml_node& band : document.child("PAMDataset").children("PAMRasterBand")) {
    read_side_band(band, metadata);
  }
}

std::optional<std::array<std::size_t, 3>> TiffMetadata::colour_bands() const {
  std::array<std::size_t, 3> found{};
  constexpr std::array kColours = {"Red", "Green", "Blue"};
  for (std::size_t c = 0; c < found.size(); ++c) {
    const auto band = std::ranges::find(bands, kColours[c], &BandMetadata::colour);
    if (band == bands.end()) return {};
    found[c] = static_cast<std::size_t>(band - bands.begin());
  }
  return found;
}

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
