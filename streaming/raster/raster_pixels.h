#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "streaming/numbers/coding_options.h"
#include "streaming/raster/raster_file.h"
#include "streaming/raster/raster_samples.h"

namespace terrella {

/// Conversion of the pixels of a raster to colours or numbers.
struct PixelReading {
  std::vector<std::size_t> bands = {};          ///< bands that are read, counted from 0: the samples of a pixel
  RasterSamples samples = {};                   ///< type and meaning of the bands that are read
  std::optional<ColourConverter> colours = {};  ///< none: numbers
  NumberCoding numbers = {};
};

/// Chooses how pixels become colours, with a stretch where one is needed (find_stretch()). Blocks. thread: any
[[nodiscard]] Result<PixelReading> colours_of(const RasterFile& file, const CodingOptions& options);

/// Chooses how a band becomes numbers, with the header's scale and offset. Fails for a picture in colours of which no
/// band was chosen. The error names the file. thread: any
[[nodiscard]] Result<PixelReading> numbers_of(const RasterFile& file, const CodingOptions& options);

/// Bands whose samples are the raster's colours.
struct ColourBands {
  RasterColour colour = RasterColour::gray;
  std::vector<std::size_t> bands;    ///< one for gray and palette, three for RGB
  std::optional<std::size_t> alpha;  ///< the band of opacity
  [[nodiscard]] bool in_colours() const { return colour == RasterColour::rgb || colour == RasterColour::palette; }
};
[[nodiscard]] ColourBands colour_bands(const RasterHeader& header);

/// Reads pixels as RGBA8, 4 bytes each, with the mask applied. The error does not name the file. thread: any
[[nodiscard]] Status read_colours(const RasterFile& file, const PixelReading& reading, const PixelWindow& window,
                                  std::uint8_t* rgba);
/// Reads pixels as numbers; NaN for no data. thread: any
[[nodiscard]] Status read_numbers(const RasterFile& file, const PixelReading& reading, const PixelWindow& window,
                                  float* numbers);
/// Reads the stored number of one pixel of the finest level; neither mask nor no data count. thread: any
[[nodiscard]] Result<double> read_exact(const RasterFile& file, const PixelReading& reading, std::int64_t x,
                                        std::int64_t y);

/// Applies a mask (0: hidden … 255: shown) to pixels. thread: any
void hide_colours(const std::uint8_t* shown, std::size_t pixels, std::uint8_t* rgba);
void hide_numbers(const std::uint8_t* shown, std::size_t pixels, float* numbers);

/// The pixels of a block that lie inside its level.
[[nodiscard]] PixelWindow window_of_block(const RasterHeader& header, std::size_t level, std::int64_t column,
                                          std::int64_t row);

/// Reads the numbers of a level: all of them, or those of at most 64 blocks or rows. No data is NaN. The error names
/// the file. Blocks. thread: any
[[nodiscard]] Result<std::vector<float>> sample_level(const RasterFile& file, std::size_t level,
                                                      const PixelReading& reading);

/// Finds the range of values that a picture shows from black to white. Returns nothing for pictures that need no
/// stretch: 8-bit samples, palettes, and 16-bit samples whose values use the upper half of the range. The range is that
/// of the stated statistics, else the 2nd to the 98th percentile of the coarsest level, or of a part of it. All colours
/// share one range. Blocks. thread: any
[[nodiscard]] Result<std::optional<Stretch>> find_stretch(const RasterFile& file, const ColourBands& bands,
                                                          const std::optional<double>& nodata);

}  // namespace terrella
