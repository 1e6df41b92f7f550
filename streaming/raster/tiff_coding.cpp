#include "streaming/raster/tiff_coding.h"

#include <fmt/format.h>

#include "streaming/raster/tiff_stretch.h"

namespace terrella {

Result<ColourConverter> colours_of(const TiffPyramid& pyramid, const CodingOptions& options) {
  TiffSamples samples = pyramid.whole().part.picture.samples;
  samples.nodata = options.nodata ? options.nodata : pyramid.metadata.nodata;
  const auto stretch = find_stretch(pyramid, samples.nodata);
  if (!stretch) return stretch.error();
  samples.stretch = *stretch;
  return ColourConverter(std::move(samples));
}

Result<NumberCoding> numbers_of(const TiffPyramid& pyramid, const CodingOptions& options) {
  const TiffPart& part = pyramid.whole().part;
  const TiffColour colour = part.picture.samples.colour;
  if (colour == TiffColour::rgb || colour == TiffColour::palette) {
    return Error{
        fmt::format("{}: heights need one number a pixel, and this is a picture in colours; take one of its "
                    "bands (gdal_translate -b 1)",
                    part.file->name())};
  }
  const TiffMetadata& metadata = pyramid.metadata;
  return NumberCoding{.nodata = options.nodata ? options.nodata : metadata.nodata,
                      .scale = options.scale.value_or(metadata.scale),
                      .offset = options.offset.value_or(metadata.offset)};
}

}  // namespace terrella
