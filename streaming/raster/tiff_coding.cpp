#include "streaming/raster/tiff_coding.h"

#include <fmt/format.h>

#include <algorithm>

#include "streaming/raster/tiff_stretch.h"

namespace terrella {

namespace {

Error no_band(const TiffPart& part, std::size_t band) {
  return Error{fmt::format("{}: it has {} band{}, and band {} is wanted; bands are counted from 1", part.file->name(),
                           part.picture.samples.per_pixel, part.picture.samples.per_pixel == 1 ? "" : "s", band + 1)};
}

Error palette_numbers(const TiffPart& part) {
  return Error{fmt::format(
      "{}: its numbers are indices of a palette, not values; leave --band, --bands, --colormap and --stretch out, or "
      "expand it (gdal_translate -expand rgb)",
      part.file->name())};
}

/// Chooses the range of each of three bands.
Result<ColourConverter> composite_of(const TiffPyramid& pyramid, TiffSamples samples, const BandComposite& composite) {
  const TiffPart& part = pyramid.whole().part;
  if (samples.colour == TiffColour::palette) return palette_numbers(part);
  std::array<BandStretch, 3> chosen;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t band = composite.bands[c];
    if (band >= samples.per_pixel) return no_band(part, band);
    chosen[c].band = band;
    chosen[c].stretch = {.low = 0.0, .high = (1 << std::min(samples.stored_bits, 16)) - 1.0};
    if (!composite.stretch[c] && samples.type == SampleType::uint8) continue;
    const StretchRule rule = composite.stretch[c].value_or(StretchRule{});
    NumberStatistics statistics;
    if (rule.kind != StretchRule::Kind::range) {
      auto sampled = sample_band(pyramid.levels.front(), {.band = band, .nodata = samples.nodata});
      if (!sampled) return sampled.error();
      statistics = statistics_of(*std::move(sampled));
    }
    chosen[c].stretch = stretch_by(rule, statistics);
  }
  samples.composite = chosen;
  return ColourConverter(std::move(samples));
}

}  // namespace

Result<ColourConverter> colours_of(const TiffPyramid& pyramid, const CodingOptions& options) {
  TiffSamples samples = pyramid.whole().part.picture.samples;
  samples.nodata = options.nodata ? options.nodata : pyramid.metadata.nodata;
  if (options.composite) return composite_of(pyramid, std::move(samples), *options.composite);
  const auto said = pyramid.metadata.colour_bands();
  const bool usual = samples.colour == TiffColour::palette ||
                     (samples.colour == TiffColour::rgb && said == std::array<std::size_t, 3>{0, 1, 2});
  if (said && !usual && std::ranges::max(*said) < samples.per_pixel) {
    return composite_of(pyramid, std::move(samples), {.bands = *said, .stretch = {}});
  }
  const auto stretch = find_stretch(pyramid, samples.nodata);
  if (!stretch) return stretch.error();
  samples.stretch = *stretch;
  return ColourConverter(std::move(samples));
}

Result<NumberCoding> numbers_of(const TiffPyramid& pyramid, const CodingOptions& options) {
  const TiffPart& part = pyramid.whole().part;
  const TiffColour colour = part.picture.samples.colour;
  if (options.band && colour == TiffColour::palette) return palette_numbers(part);
  if (options.band && *options.band >= part.picture.samples.per_pixel) return no_band(part, *options.band);
  if (!options.band && (colour == TiffColour::rgb || colour == TiffColour::palette)) {
    return Error{
        fmt::format("{}: heights and other numbers are one a pixel, and this is a picture in colours; take one of its "
                    "bands (gdal_translate -b 1)",
                    part.file->name())};
  }
  const std::size_t band = options.band.value_or(0);
  const BandMetadata metadata = pyramid.metadata.band(band);
  return NumberCoding{.band = band,
                      .nodata = options.nodata ? options.nodata : pyramid.metadata.nodata,
                      .scale = options.scale.value_or(metadata.scale),
                      .offset = options.offset.value_or(metadata.offset)};
}

}  // namespace terrella
