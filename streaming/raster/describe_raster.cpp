#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "streaming/raster/open_raster.h"
#include "streaming/raster/raster_pixels.h"

namespace terrella {
namespace {

/// Sums up the numbers of a band; nothing for a picture that has none.
Result<std::optional<NumberStatistics>> statistics_in(const RasterFile& file, const DescribedBand& wanted) {
  CodingOptions options{.nodata = wanted.nodata};
  if (wanted.band > 0) options.band = static_cast<std::size_t>(wanted.band - 1);
  if (!options.band && colour_bands(file.header()).in_colours()) return std::optional<NumberStatistics>();
  auto reading = numbers_of(file, options);
  if (!reading) return reading.error();
  const double scale = std::exchange(reading->numbers.scale, 1.0);
  const double offset = std::exchange(reading->numbers.offset, 0.0);
  auto numbers = sample_level(file, 0, *reading);
  if (!numbers) return numbers.error();
  return std::optional(statistics_of(*std::move(numbers), scale, offset));
}

/// Says how a picture of numbers is shown.
Result<std::vector<std::string>> stretch_notes(const RasterFile& file) {
  const auto reading = colours_of(file, {});
  if (!reading) return reading.error();
  std::vector<std::string> notes;
  if (const auto& stretch = reading->samples.stretch) {
    const RasterBand& band = file.header().bands[reading->bands.front()];
    const bool said = band.least && band.most;
    notes.push_back(fmt::format("as a picture it shows values from {:.6g} to {:.6g} from black to white ({})",
                                stretch->low, stretch->high,
                                said ? "the range in its metadata" : "the 2nd to the 98th percentile"));
  }
  return notes;
}

std::string samples_title(const RasterBand& band) {
  RasterSamples samples;
  samples.type = band.type;
  samples.stored_bits = band.stored_bits;
  return samples.title();
}

}  // namespace

Result<RasterFacts> describe_raster(const RasterFile& file, const DescribedBand& wanted, bool with_values) {
  const RasterHeader& header = file.header();
  const auto index = static_cast<std::size_t>(std::max(wanted.band, 1) - 1);
  const RasterBand band = index < header.bands.size() ? header.bands[index] : RasterBand{};
  RasterFacts facts{.width_px = header.whole().width_px,
                    .height_px = header.whole().height_px,
                    .bands = static_cast<int>(header.bands.size()),
                    .samples = samples_title(header.bands.front()),
                    .layout = header.layout,
                    .overviews = {},
                    .has_mask = header.has_mask,
                    .nodata = band.nodata,
                    .scale = band.scale,
                    .offset = band.offset,
                    .unit = band.unit,
                    .quantity = band.description,
                    .notes = header.remarks};
  for (std::size_t i = header.levels.size() - 1; i-- > 0;) {
    facts.overviews.emplace_back(header.levels[i].width_px, header.levels[i].height_px);
  }
  if (!with_values) return facts;
  auto statistics = statistics_in(file, wanted);
  if (!statistics) return statistics.error();
  facts.statistics = *std::move(statistics);
  const auto notes = stretch_notes(file);
  if (!notes) return notes.error();
  facts.notes.insert(facts.notes.end(), notes->begin(), notes->end());
  return facts;
}

}  // namespace terrella
