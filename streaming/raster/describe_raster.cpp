#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <utility>

#include "streaming/file_bytes.h"
#include "streaming/raster/open_raster.h"
#include "streaming/raster/tiff_coding.h"
#include "streaming/raster/tiff_stretch.h"
#include "streaming/tiff_open.h"

namespace terrella {
namespace {

std::string compression_title(int compression) {
  constexpr std::array<std::pair<int, const char*>, 10> kTitles{{{COMPRESSION_NONE, "not compressed"},
                                                                 {COMPRESSION_LZW, "LZW"},
                                                                 {COMPRESSION_JPEG, "JPEG"},
                                                                 {COMPRESSION_DEFLATE, "deflate"},
                                                                 {COMPRESSION_ADOBE_DEFLATE, "deflate"},
                                                                 {COMPRESSION_PACKBITS, "PackBits"},
                                                                 {COMPRESSION_LZMA, "LZMA"},
                                                                 {COMPRESSION_ZSTD, "ZSTD"},
                                                                 {COMPRESSION_WEBP, "WebP"},
                                                                 {COMPRESSION_LERC, "LERC"}}};
  for (const auto& [scheme, title] : kTitles) {
    if (scheme == compression) return title;
  }
  return fmt::format("compression {}", compression);
}

std::string colour_title(const TiffSamples& samples) {
  constexpr std::array kTitles{"gray", "gray, white is 0", "RGB", "palette"};
  return fmt::format("{}{}", kTitles[static_cast<std::size_t>(samples.colour)],
                     samples.alpha == TiffAlpha::none ? "" : " with alpha");
}

std::string layout_title(const TiffPicture& picture) {
  const std::string blocks =
      picture.tiled ? fmt::format("tiles of {}x{}", picture.tile_width_px, picture.tile_height_px) : "strips";
  return fmt::format("{}, {}{}, {}", colour_title(picture.samples), blocks, picture.separate ? ", bands separate" : "",
                     compression_title(picture.compression));
}

/// Sums up the numbers of a band; nothing for a picture that has none.
Result<std::optional<NumberStatistics>> statistics_in(const TiffPyramid& pyramid, const DescribedBand& wanted) {
  CodingOptions options{.nodata = wanted.nodata};
  if (wanted.band > 0) options.band = static_cast<std::size_t>(wanted.band - 1);
  const TiffColour colour = pyramid.whole().part.picture.samples.colour;
  if (!options.band && (colour == TiffColour::rgb || colour == TiffColour::palette)) {
    return std::optional<NumberStatistics>();
  }
  auto coding = numbers_of(pyramid, options);
  if (!coding) return coding.error();
  const double scale = std::exchange(coding->scale, 1.0);
  const double offset = std::exchange(coding->offset, 0.0);
  auto numbers = sample_band(pyramid.levels.front(), *coding);
  if (!numbers) return numbers.error();
  return std::optional(statistics_of(*std::move(numbers), scale, offset));
}

/// Says how a picture of numbers is shown.
Result<std::vector<std::string>> stretch_notes(const TiffPyramid& pyramid) {
  const auto colours = colours_of(pyramid, {});
  if (!colours) return colours.error();
  std::vector<std::string> notes;
  if (const auto& stretch = colours->samples().stretch) {
    const bool said = pyramid.metadata.least && pyramid.metadata.most;
    notes.push_back(fmt::format("as a picture it shows values from {:.6g} to {:.6g} from black to white ({})",
                                stretch->low, stretch->high,
                                said ? "the range in its metadata" : "the 2nd to the 98th percentile"));
  }
  return notes;
}

}  // namespace

bool holds_numbers(const TiffPyramid& pyramid) {
  const TiffSamples& samples = pyramid.whole().part.picture.samples;
  return samples.colour == TiffColour::gray && samples.type != SampleType::uint8 && !pyramid.metadata.colour_bands();
}

bool holds_numbers(const std::filesystem::path& path) {
  const auto head = read_head(path, 8);
  if (!head || !begins_as_tiff({reinterpret_cast<const char*>(head->data()), head->size()})) return false;
  const auto pyramid = read_pyramid(path);
  return pyramid && holds_numbers(*pyramid);
}

Result<RasterFacts> describe_raster(const TiffPyramid& pyramid, const DescribedBand& wanted, bool with_values) {
  const TiffPicture& picture = pyramid.whole().part.picture;
  const BandMetadata band = pyramid.metadata.band(static_cast<std::size_t>(std::max(wanted.band, 1) - 1));
  RasterFacts facts{.width_px = picture.width_px,
                    .height_px = picture.height_px,
                    .bands = static_cast<int>(picture.samples.per_pixel),
                    .samples = picture.samples.title(),
                    .layout = layout_title(picture),
                    .overviews = {},
                    .has_mask = pyramid.whole().mask.has_value(),
                    .nodata = pyramid.metadata.nodata,
                    .scale = band.scale,
                    .offset = band.offset,
                    .unit = band.unit,
                    .quantity = band.description,
                    .notes = {}};
  for (std::size_t i = pyramid.levels.size() - 1; i-- > 0;) {
    const TiffPicture& overview = pyramid.levels[i].part.picture;
    facts.overviews.emplace_back(overview.width_px, overview.height_px);
  }
  if (!with_values) return facts;
  auto statistics = statistics_in(pyramid, wanted);
  if (!statistics) return statistics.error();
  facts.statistics = *std::move(statistics);
  auto notes = stretch_notes(pyramid);
  if (!notes) return notes.error();
  facts.notes = *std::move(notes);
  return facts;
}

Result<std::optional<RasterFacts>> describe_raster(const std::filesystem::path& path, const DescribedBand& wanted) {
  const auto head = read_head(path, 8);
  if (!head) return Error{head.error().message};
  if (!begins_as_tiff({reinterpret_cast<const char*>(head->data()), head->size()})) {
    return std::optional<RasterFacts>{};
  }
  const auto pyramid = read_pyramid(path);
  if (!pyramid) return pyramid.error();
  auto facts = describe_raster(*pyramid, wanted, true);
  if (!facts) return facts.error();
  return std::optional(*std::move(facts));
}

}  // namespace terrella
