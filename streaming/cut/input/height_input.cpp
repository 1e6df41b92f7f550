#include "streaming/cut/input/height_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "streaming/cut/input/row_formats.h"
#include "streaming/file_bytes.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/raster/raster_pixels.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Number of 16-bit values for known heights. The remaining value means "no height".
constexpr double kFloatNumbers = 65534.0;
constexpr int kFloatNodata = 65535;
constexpr int kInt16Shift = 32768;

struct Probe {
  HeightKind kind = HeightKind::uint16;
  std::optional<double> nodata = {};
  double scale = 1.0;  ///< metres = number · scale + offset
  double offset = 0.0;
  bool eight_bits = false;
  RasterBand band = {};
};

HeightKind kind_of(SampleType type) {
  if (type == SampleType::uint8 || type == SampleType::uint16) return HeightKind::uint16;
  return type == SampleType::int8 || type == SampleType::int16 ? HeightKind::int16 : HeightKind::float32;
}

Result<Probe> probe_raster(const RasterFile& file, std::optional<std::size_t> band) {
  const auto reading = numbers_of(file, {.band = band});
  if (!reading) return reading.error();
  const SampleType type = reading->samples.type;
  return Probe{.kind = kind_of(type),
               .nodata = reading->numbers.nodata,
               .scale = reading->numbers.scale,
               .offset = reading->numbers.offset,
               .eight_bits = type == SampleType::uint8 || type == SampleType::int8,
               .band = file.header().bands[band.value_or(0)]};
}

Result<Probe> probe_file(const fs::path& image, std::optional<std::size_t> band) {
  if (Status regular = check_regular(image); !regular) return regular.error();
  // The reader of a plain picture checks it.
  if (picture_kind(image) != PictureKind::raster) return Probe{};
  const auto file = RasterFile::open(image.string());
  return file ? probe_raster(**file, band) : Result<Probe>(file.error());
}

/// Drops a nodata value that no sample of this kind can have.
std::optional<double> possible(std::optional<double> nodata, HeightKind kind) {
  if (!nodata || kind == HeightKind::float32) return nodata;
  const double least = kind == HeightKind::int16 ? -32768.0 : 0.0;
  const bool fits = *nodata == std::round(*nodata) && *nodata >= least && *nodata <= least + 65535.0;
  return fits ? nodata : std::nullopt;
}

struct Range {
  float least = std::numeric_limits<float>::infinity();
  float most = -std::numeric_limits<float>::infinity();
};

/// Widens the range by the raw samples, with scale 1 and offset 0.
Status widen(const fs::path& image, const HeightCoding& coding, int jobs, Range& range) {
  auto reader = open_height_rows(image, coding, jobs);
  if (!reader) return reader.error();
  const auto width = static_cast<std::size_t>((*reader)->info().width_px);
  std::vector<std::uint8_t> row(width * 4);
  for (std::int64_t y = 0; y < (*reader)->info().height_px; ++y) {
    if (Status read = (*reader)->read_row(row); !read) return read;
    for (std::size_t x = 0; x < width; ++x) {
      float height = 0.0F;
      std::memcpy(&height, row.data() + x * 4, sizeof(height));
      if (!std::isfinite(height)) continue;
      range.least = std::min(range.least, height);
      range.most = std::max(range.most, height);
    }
  }
  return Done{};
}

/// Numbers that stay floats.
HeightPlan keep_floats(HeightPlan plan, const Probe& probe) {
  plan.coding.sample_scale = probe.scale;
  plan.coding.sample_offset = probe.offset;
  plan.numbers.floats = true;
  plan.numbers.nodata = plan.coding.nodata;
  return plan;
}

Result<HeightPlan> plan_floats(const HeightPictures& pictures, const CutElevation& options, int jobs,
                               const Probe& probe, HeightPlan plan) {
  if (options.scale || options.offset) {
    plan.numbers.scale = options.scale.value_or(1.0);
    plan.numbers.offset = options.offset.value_or(0.0);
  } else {
    Range range;
    for (const fs::path& image : pictures.images) {
      const Status widened = widen(image, plan.coding, jobs, range);
      // The range of a picture with unreadable parts is unknown. Floats keep all values that can be read.
      if (!widened && pictures.many) return keep_floats(std::move(plan), probe);
      if (!widened) return widened.error();
    }
    if (range.least > range.most) {
      return Error{
          fmt::format("{}: holds no height: each pixel is no data or not a number; say with ‹nodata› which value "
                      "means no data, or name another file",
                      pictures.images.front().string())};
    }
    const double span = static_cast<double>(range.most) - static_cast<double>(range.least);
    plan.numbers.scale = span > 0.0 ? span / kFloatNumbers : 1.0;
    plan.numbers.offset = range.least;
  }
  plan.numbers.nodata = kFloatNodata;
  plan.coding.scale = plan.numbers.scale;
  plan.coding.offset = plan.numbers.offset;
  return plan;
}

class BetweenNodes : public RowReader {
 public:
  explicit BetweenNodes(std::unique_ptr<RowReader> nodes) : nodes_(std::move(nodes)), info_(nodes_->info()) {
    --info_.height_px;
    above_.resize(static_cast<std::size_t>(info_.width_px));
    below_.resize(above_.size());
  }
  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> numbers) override {
    if (!begun_) {
      if (Status read = read_nodes(below_); !read) return read;
      begun_ = true;
    }
    std::swap(above_, below_);
    if (Status read = read_nodes(below_); !read) return read;
    for (std::size_t x = 0; x < above_.size(); ++x) {
      const std::size_t east = x + 1 == above_.size() ? 0 : x + 1;
      const float mean = mean_of({above_[x], above_[east], below_[x], below_[east]});
      std::memcpy(numbers.data() + x * 4, &mean, sizeof(mean));
    }
    return Done{};
  }

 private:
  Status read_nodes(std::vector<float>& row) {
    return nodes_->read_row({reinterpret_cast<std::uint8_t*>(row.data()), row.size() * sizeof(float)});
  }

  static float mean_of(const std::array<float, 4>& corners) {
    float sum = 0.0F;
    float known = 0.0F;
    for (const float corner : corners) {
      if (std::isnan(corner)) continue;
      sum += corner;
      known += 1.0F;
    }
    return sum / known;  // NaN if no corner is known
  }

  std::unique_ptr<RowReader> nodes_;
  PictureInfo info_;
  bool begun_ = false;
  std::vector<float> above_, below_;
};

}  // namespace

namespace {

/// The kind of the pictures, which must be one.
Result<Probe> probe_all(const HeightPictures& pictures, std::optional<std::size_t> band) {
  if (pictures.remote != nullptr) return probe_raster(*pictures.remote, band);
  std::optional<Probe> first;
  for (const fs::path& image : pictures.images) {
    const auto probe = probe_file(image, band);
    if (!probe) return probe.error();
    if (!first) first = *probe;
    if (probe->kind != first->kind || probe->scale != first->scale || probe->offset != first->offset) {
      return Error{
          fmt::format("{}: its numbers are of another kind or scale than those of {}; convert it (gdal_translate -ot)",
                      image.string(), pictures.images.front().string())};
    }
  }
  return *first;
}

/// The kind of rasters that are one layer: floats in values if they differ. Rasters that cannot be read are left out.
Result<Probe> probe_many(const std::vector<fs::path>& images, std::size_t band) {
  std::optional<Probe> first;
  std::optional<Error> failed;
  for (const fs::path& image : images) {
    const auto probe = probe_file(image, band);
    if (!probe) {
      if (!failed) failed = probe.error();
      continue;
    }
    if (!first) first = *probe;
    if (probe->kind == first->kind && probe->scale == first->scale && probe->offset == first->offset &&
        probe->nodata == first->nodata) {
      continue;
    }
    first->kind = HeightKind::float32;
    first->nodata.reset();
  }
  if (!first) return failed.value_or(Error{"no raster is named"});
  return *first;
}

}  // namespace

Result<HeightPlan> plan_heights(const HeightPictures& pictures, const CutElevation& options, int jobs) {
  HeightPlan plan;
  plan.numbers.unit = "m";
  plan.numbers.quantity = "height";
  const auto first = probe_all(pictures, {});
  if (!first) return first.error();
  if (options.scale && (*options.scale == 0.0 || !std::isfinite(*options.scale))) {
    return Error{"‹scale›: it takes metres per number, not 0"};
  }
  plan.coding = {.kind = first->kind, .nodata = possible(options.nodata ? options.nodata : first->nodata, first->kind)};
  if (first->kind == HeightKind::float32) {
    if (pictures.remote != nullptr && !options.scale && !options.offset) return keep_floats(std::move(plan), *first);
    plan.coding.sample_scale = first->scale;
    plan.coding.sample_offset = first->offset;
    return plan_floats(pictures, options, jobs, *first, plan);
  }
  const int shift = first->kind == HeightKind::int16 ? kInt16Shift : 0;
  plan.numbers.scale = options.scale.value_or(first->scale);
  plan.numbers.offset = options.offset.value_or(first->offset) - shift * plan.numbers.scale;
  if (plan.coding.nodata) plan.numbers.nodata = static_cast<int>(*plan.coding.nodata) + shift;
  return plan;
}

Result<HeightPlan> plan_numbers(const HeightPictures& pictures, const CutNumbers& options, bool may_have_gaps) {
  const auto band = static_cast<std::size_t>(options.band - 1);
  const auto probe = pictures.many ? probe_many(pictures.images, band) : probe_all(pictures, band);
  if (!probe) return probe.error();
  HeightPlan plan;
  plan.numbers.unit = probe->band.unit;
  plan.numbers.quantity = probe->band.description;
  const auto nodata = possible(options.nodata ? options.nodata : probe->nodata, probe->kind);
  plan.coding = {.kind = probe->kind, .band = band, .nodata = nodata};
  if (!nodata && may_have_gaps && !probe->eight_bits) plan.coding.kind = HeightKind::float32;
  if (plan.coding.kind == HeightKind::float32) return keep_floats(std::move(plan), *probe);
  const int shift = probe->kind == HeightKind::int16 ? kInt16Shift : 0;
  plan.numbers.scale = probe->scale;
  plan.numbers.offset = probe->offset - shift * probe->scale;
  if (nodata) plan.numbers.nodata = *nodata + shift;
  return plan;
}

RasterOptions raster_of(const HeightPlan& plan) {
  RasterOptions options;
  options.heights = true;
  options.nodata = plan.coding.nodata;
  options.band = static_cast<int>(plan.coding.band) + (plan.coding.band > 0 ? 1 : 0);
  const bool is_float = plan.coding.kind == HeightKind::float32;
  const int shift = plan.coding.kind == HeightKind::int16 ? kInt16Shift : 0;
  options.scale = is_float ? plan.coding.sample_scale : plan.numbers.scale;
  options.offset = is_float ? plan.coding.sample_offset : plan.numbers.offset + shift * plan.numbers.scale;
  return options;
}

bool is_node_planet(std::int64_t width, std::int64_t height) { return width % 2 == 0 && height == width / 2 + 1; }

std::unique_ptr<RowReader> between_nodes(std::unique_ptr<RowReader> nodes) {
  return std::make_unique<BetweenNodes>(std::move(nodes));
}

}  // namespace terrella
