#include "streaming/raster/raster_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace terrella {
namespace {

std::size_t pixel_count(const PixelWindow& window) {
  return static_cast<std::size_t>(window.width_px * window.height_px);
}

Result<std::vector<std::uint8_t>> read_samples(const RasterFile& file, const PixelReading& reading,
                                               const PixelWindow& window) {
  std::vector<std::uint8_t> samples(pixel_count(window) * reading.samples.pixel_bytes());
  if (Status read = file.read(window, reading.bands, reading.samples.type, samples.data()); !read) return read.error();
  return samples;
}

/// Opacity of the pixels; empty without a mask.
Result<std::vector<std::uint8_t>> read_opacity(const RasterFile& file, const PixelWindow& window) {
  std::vector<std::uint8_t> shown;
  if (!file.header().has_mask) return shown;
  shown.resize(pixel_count(window));
  if (Status read = file.read_mask(window, shown.data()); !read) return read.error();
  return shown;
}

constexpr std::int64_t kSampledPieces = 64;
constexpr std::int64_t kSampledPixels = 1 << 25;

Error no_band(const RasterFile& file, std::size_t band) {
  const std::size_t bands = file.header().bands.size();
  return Error{fmt::format("{}: it has {} band{}, and band {} is wanted; bands are counted from 1", file.name(), bands,
                           bands == 1 ? "" : "s", band + 1)};
}

Error palette_numbers(const RasterFile& file) {
  return Error{fmt::format(
      "{}: its numbers are indices of a palette, not values; leave ‹band›, ‹bands›, ‹colormap› and ‹stretch› out, or "
      "expand it (gdal_translate -expand rgb)",
      file.name())};
}

/// Samples of the given bands, and of the band of opacity after them.
PixelReading reading_of(const RasterHeader& header, const ColourBands& chosen, std::vector<std::size_t> bands) {
  PixelReading reading{.bands = std::move(bands)};
  const RasterBand& first = header.bands[reading.bands.front()];
  reading.samples.type = first.type;
  reading.samples.stored_bits = first.stored_bits;
  reading.samples.colour = reading.bands.size() == 3 ? RasterColour::rgb : RasterColour::gray;
  const bool has_alpha = chosen.alpha && std::ranges::find(reading.bands, *chosen.alpha) == reading.bands.end();
  if (has_alpha) {
    reading.bands.push_back(*chosen.alpha);
    reading.samples.alpha =
        header.bands[*chosen.alpha].premultiplied ? RasterAlpha::premultiplied : RasterAlpha::straight;
  }
  reading.samples.per_pixel = reading.bands.size();
  return reading;
}

/// Chooses the range of each of three bands.
Result<PixelReading> composite_of(const RasterFile& file, const ColourBands& colours, const BandComposite& composite,
                                  const std::optional<double>& nodata) {
  const RasterHeader& header = file.header();
  if (colours.colour == RasterColour::palette) return palette_numbers(file);
  for (const std::size_t band : composite.bands) {
    if (band >= header.bands.size()) return no_band(file, band);
  }
  PixelReading reading = reading_of(header, colours, {composite.bands.begin(), composite.bands.end()});
  reading.samples.nodata = nodata;
  std::array<BandStretch, 3> chosen;
  for (std::size_t c = 0; c < 3; ++c) {
    chosen[c].band = c;
    chosen[c].stretch = {.low = 0.0, .high = (1 << std::min(reading.samples.stored_bits, 16)) - 1.0};
    if (!composite.stretch[c] && reading.samples.type == SampleType::uint8) continue;
    const StretchRule rule = composite.stretch[c].value_or(StretchRule{});
    NumberStatistics statistics;
    if (rule.kind != StretchRule::Kind::range) {
      PixelReading numbers = reading_of(header, {}, {composite.bands[c]});
      numbers.numbers.nodata = nodata;
      auto sampled = sample_level(file, 0, numbers);
      if (!sampled) return sampled.error();
      statistics = statistics_of(*std::move(sampled));
    }
    chosen[c].stretch = stretch_by(rule, statistics);
  }
  reading.samples.composite = chosen;
  reading.colours.emplace(reading.samples);
  return reading;
}

/// Number of pieces to read, of `count` pieces of `pixels` pixels each.
std::int64_t pieces_to_read(std::int64_t count, std::int64_t pixels) {
  return std::clamp<std::int64_t>(kSampledPixels / pixels, 1, std::min(count, kSampledPieces));
}

/// The value below which a share of the values lies. Reorders the values.
double percentile(std::vector<float>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, values.begin() + at);
  return static_cast<double>(values[static_cast<std::size_t>(at)]);
}

Result<Stretch> range_of_samples(const RasterFile& file, const ColourBands& colours,
                                 const std::optional<double>& nodata) {
  std::vector<float> values;
  for (const std::size_t band : colours.bands) {
    PixelReading reading = reading_of(file.header(), colours, {band});
    reading.numbers.nodata = nodata;
    const auto sampled = sample_level(file, 0, reading);
    if (!sampled) return sampled.error();
    values.insert(values.end(), sampled->begin(), sampled->end());
  }
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  if (values.empty()) return Stretch{.low = 0.0, .high = 1.0};
  const double low = percentile(values, 0.02);
  return Stretch{.low = low, .high = percentile(values, 0.98)};
}

/// The range of the stated statistics of the colours; none unless they are stated.
std::optional<Stretch> stated_range(const RasterHeader& header, const ColourBands& colours) {
  std::optional<Stretch> range;
  for (const std::size_t band : colours.bands) {
    const RasterBand& facts = header.bands[band];
    if (!facts.least || !facts.most) continue;
    if (!range) range = Stretch{.low = *facts.least, .high = *facts.most};
    range = {.low = std::min(range->low, *facts.least), .high = std::max(range->high, *facts.most)};
  }
  return range;
}

}  // namespace

void hide_colours(const std::uint8_t* shown, std::size_t pixels, std::uint8_t* rgba) {
  for (std::size_t i = 0; i < pixels; ++i) {
    rgba[4 * i + 3] = static_cast<std::uint8_t>((rgba[4 * i + 3] * shown[i] + 127) / 255);
  }
}

void hide_numbers(const std::uint8_t* shown, std::size_t pixels, float* numbers) {
  for (std::size_t i = 0; i < pixels; ++i) {
    if (shown[i] < 128) numbers[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

Status read_colours(const RasterFile& file, const PixelReading& reading, const PixelWindow& window,
                    std::uint8_t* rgba) {
  const auto samples = read_samples(file, reading, window);
  if (!samples) return samples.error();
  const auto shown = read_opacity(file, window);
  if (!shown) return shown.error();
  reading.colours->to_rgba(samples->data(), pixel_count(window), rgba);
  hide_colours(shown->data(), shown->size(), rgba);
  return Done{};
}

Status read_numbers(const RasterFile& file, const PixelReading& reading, const PixelWindow& window, float* numbers) {
  const auto samples = read_samples(file, reading, window);
  if (!samples) return samples.error();
  const auto shown = read_opacity(file, window);
  if (!shown) return shown.error();
  to_floats(reading.samples, reading.numbers, samples->data(), pixel_count(window), numbers);
  hide_numbers(shown->data(), shown->size(), numbers);
  return Done{};
}

Result<double> read_exact(const RasterFile& file, const PixelReading& reading, std::int64_t x, std::int64_t y) {
  const auto pixel = read_samples(
      file, reading, {.level = file.header().levels.size() - 1, .x = x, .y = y, .width_px = 1, .height_px = 1});
  if (!pixel) return pixel.error();
  return exact_sample(reading.samples, reading.numbers.band, pixel->data());
}

PixelWindow window_of_block(const RasterHeader& header, std::size_t level, std::int64_t column, std::int64_t row) {
  const RasterShape& shape = header.levels[level];
  PixelWindow window{.level = level, .x = column * shape.block_width_px, .y = row * shape.block_height_px};
  window.width_px = std::min(shape.block_width_px, shape.width_px - window.x);
  window.height_px = std::min(shape.block_height_px, shape.height_px - window.y);
  return window;
}

ColourBands colour_bands(const RasterHeader& header) {
  ColourBands found;
  const auto find = [&](BandColour colour) -> std::optional<std::size_t> {
    const auto band = std::ranges::find(header.bands, colour, &RasterBand::colour);
    if (band == header.bands.end()) return {};
    return static_cast<std::size_t>(band - header.bands.begin());
  };
  found.alpha = find(BandColour::alpha);
  if (found.alpha == std::size_t{0}) found.alpha.reset();  // a raster of opacity alone is a gray one
  const auto red = find(BandColour::red), green = find(BandColour::green), blue = find(BandColour::blue);
  found.bands = {0};
  if (red && green && blue) {
    found.colour = RasterColour::rgb;
    found.bands = {*red, *green, *blue};
  } else if (header.bands.front().colour == BandColour::palette && !header.palette.empty()) {
    found.colour = RasterColour::palette;
  } else if (header.inverted) {
    found.colour = RasterColour::gray_inverted;
  }
  return found;
}

Result<PixelReading> colours_of(const RasterFile& file, const CodingOptions& options) {
  const RasterHeader& header = file.header();
  const ColourBands colours = colour_bands(header);
  const auto nodata = options.nodata ? options.nodata : header.bands[colours.bands.front()].nodata;
  if (options.composite) return composite_of(file, colours, *options.composite, nodata);
  if (header.bands.front().colour == BandColour::other) {
    return Error{fmt::format(
        "{}: its colours are not red, green and blue, and are not read; save it in RGB (convert -colorspace sRGB)",
        file.name())};
  }
  PixelReading reading = reading_of(header, colours, colours.bands);
  reading.samples.colour = colours.colour;
  reading.samples.nodata = nodata;
  if (colours.colour == RasterColour::palette) reading.samples.palette = header.palette;
  const auto stretch = find_stretch(file, colours, nodata);
  if (!stretch) return stretch.error();
  reading.samples.stretch = *stretch;
  reading.colours.emplace(reading.samples);
  return reading;
}

Result<PixelReading> numbers_of(const RasterFile& file, const CodingOptions& options) {
  const RasterHeader& header = file.header();
  const ColourBands colours = colour_bands(header);
  if (options.band && colours.colour == RasterColour::palette) return palette_numbers(file);
  if (options.band && *options.band >= header.bands.size()) return no_band(file, *options.band);
  if (!options.band && colours.in_colours()) {
    return Error{
        fmt::format("{}: heights and other numbers are one a pixel, and this is a picture in colours; take one of its "
                    "bands (gdal_translate -b 1)",
                    file.name())};
  }
  const std::size_t band = options.band.value_or(0);
  const RasterBand& facts = header.bands[band];
  PixelReading reading = reading_of(header, colours, {band});
  reading.numbers = {.band = 0,
                     .nodata = options.nodata ? options.nodata : facts.nodata,
                     .scale = options.scale.value_or(facts.scale),
                     .offset = options.offset.value_or(facts.offset)};
  return reading;
}

Result<std::vector<float>> sample_level(const RasterFile& file, std::size_t level, const PixelReading& reading) {
  const RasterShape& shape = file.header().levels[level];
  const std::int64_t wide = shape.has_blocks() ? shape.block_width_px : shape.width_px;
  const std::int64_t high = shape.has_blocks() ? shape.block_height_px : 1;
  const std::int64_t columns = (shape.width_px + wide - 1) / wide;
  const std::int64_t count = columns * ((shape.height_px + high - 1) / high);
  const std::int64_t reads = pieces_to_read(count, wide * high);
  std::vector<float> values;
  for (std::int64_t i = 0; i < reads; ++i) {
    const std::int64_t at = (2 * i + 1) * count / (2 * reads);
    PixelWindow window{.level = level, .x = at % columns * wide, .y = at / columns * high};
    window.width_px = std::min(wide, shape.width_px - window.x);
    window.height_px = std::min(high, shape.height_px - window.y);
    const std::size_t before = values.size();
    values.resize(before + static_cast<std::size_t>(window.width_px * window.height_px));
    if (Status read = read_numbers(file, reading, window, values.data() + before); !read) {
      return Error{fmt::format("{}: {}", file.name(), read.error().message)};
    }
  }
  return values;
}

Result<std::optional<Stretch>> find_stretch(const RasterFile& file, const ColourBands& colours,
                                            const std::optional<double>& nodata) {
  const RasterBand& first = file.header().bands[colours.bands.front()];
  if (first.type == SampleType::uint8 || colours.colour == RasterColour::palette) return std::optional<Stretch>{};
  auto range = stated_range(file.header(), colours);
  if (!range) {
    const auto sampled = range_of_samples(file, colours, nodata);
    if (!sampled) return sampled.error();
    range = *sampled;
  }
  // Values up to the upper half of 16 bits or fewer fill enough of the range to be shown unstretched.
  const double upper_half = std::ldexp(1.0, first.stored_bits - 1);
  if (first.type == SampleType::uint16 && range->high >= upper_half) return std::optional<Stretch>{};
  // A picture of one value is shown in the middle of the range.
  if (!(range->low < range->high)) range = Stretch{.low = range->low - 0.5, .high = range->low + 0.5};
  return range;
}

}  // namespace terrella
