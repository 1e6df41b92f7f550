#include <png.h>

#include <bit>
#include <cstring>
#include <vector>

#include "streaming/cut/input/row_formats.h"
#include "streaming/raster/raster_samples.h"

namespace terrella {
namespace {

constexpr png_alloc_size_t kMaxChunkBytes = 8UL << 20;

/// longjmp jumps over the C frames of libpng's callbacks.
[[noreturn]] void on_row_error(png_structp png, png_const_charp message) {
  auto* text = static_cast<char*>(png_get_error_ptr(png));
  std::snprintf(text, 128, "%s", message);
  png_longjmp(png, 1);
}

void ignore_row_warning(png_structp, png_const_charp) {}

class PngRows : public RowReader {
 public:
  PngRows(File file, std::string name, const std::optional<HeightCoding>& heights)
      : file_(std::move(file)), name_(std::move(name)), heights_(heights) {}
  ~PngRows() override { png_destroy_read_struct(&png_, &header_, nullptr); }
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  [[nodiscard]] Status open() {
    if (!read_header()) return Error{fmt::format("{}: is not a PNG that can be read: {}", name_, message_)};
    info_.width_px = png_get_image_width(png_, header_);
    info_.height_px = png_get_image_height(png_, header_);
    if (heights_ &&
        (png_get_bit_depth(png_, header_) != 16 || png_get_color_type(png_, header_) != PNG_COLOR_TYPE_GRAY)) {
      return refuse_heights(name_);
    }
    info_.has_alpha = (png_get_color_type(png_, header_) & PNG_COLOR_MASK_ALPHA) != 0 ||
                      png_get_valid(png_, header_, PNG_INFO_tRNS) != 0;
    if (Status fits = check_picture_size(name_, info_.width_px, info_.height_px); !fits) return fits;
    if (!start()) return row_error(name_, 0, info_.height_px, message_);
    return Done{};
  }

  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (passes_ > 1 && whole_.empty()) {
      if (Status read = read_interlaced(); !read) return read;
    }
    const std::uint8_t* row = passes_ > 1 ? whole_.data() + static_cast<std::size_t>(row_) * row_bytes() : nullptr;
    if (row == nullptr) {
      samples_.resize(heights_ ? row_bytes() : 0);
      std::uint8_t* to = heights_ ? samples_.data() : rgba.data();
      if (!decode_row(to)) return row_error(name_, row_, info_.height_px, message_);
      row = to;
    }
    ++row_;
    if (heights_) {
      read_heights(row, rgba);
    } else if (row != rgba.data()) {
      std::memcpy(rgba.data(), row, rgba.size());
    }
    return Done{};
  }

 private:
  void read_heights(const std::uint8_t* row, std::span<std::uint8_t> numbers) {
    RasterSamples samples;
    samples.type = SampleType::uint16;
    samples.per_pixel = 1;
    heights_row_.resize(numbers.size() / sizeof(float));
    to_floats(samples, {.nodata = heights_->nodata}, row, heights_row_.size(), heights_row_.data());
    to_numbers(*heights_, heights_row_);
    std::memcpy(numbers.data(), heights_row_.data(), numbers.size());
  }

  // Functions that call setjmp contain no objects with destructors.
  bool read_header() {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, message_, on_row_error, ignore_row_warning);
    if (png_ == nullptr) return false;
    header_ = png_create_info_struct(png_);
    if (header_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_init_io(png_, file_.get());
    png_set_chunk_malloc_max(png_, kMaxChunkBytes);
    // Larger pictures are refused later, with Terrella's own message.
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    // Skips all chunks that do not make pixels: profiles and texts can be compressed bombs.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(png_, header_);
    return true;
  }

  bool start() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    if (heights_) {
      // PNG is big-endian.
      if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    } else {
      png_set_expand(png_);
      png_set_scale_16(png_);
      png_set_gray_to_rgb(png_);
      png_set_add_alpha(png_, 0xFF, PNG_FILLER_AFTER);
    }
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, header_);
    if (png_get_rowbytes(png_, header_) != row_bytes()) png_error(png_, "the rows are of an unexpected size");
    return true;
  }

  bool decode_row(png_bytep rgba) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_row(png_, rgba, nullptr);
    return true;
  }

  Status read_interlaced() {
    const std::uint64_t held = std::uint64_t{row_bytes()} * static_cast<std::uint64_t>(info_.height_px);
    if (held > kMaxHeldBytes) {
      return Error{
          fmt::format("{}: an interlaced PNG of this size needs {} MiB of memory; save it without interlacing first",
                      name_, held >> 20)};
    }
    whole_.resize(held);
    for (int pass = 0; pass < passes_; ++pass) {
      for (std::int64_t row = 0; row < info_.height_px; ++row) {
        if (!decode_row(whole_.data() + static_cast<std::size_t>(row) * row_bytes())) {
          return row_error(name_, row, info_.height_px, message_);
        }
      }
    }
    return Done{};
  }

  [[nodiscard]] std::size_t row_bytes() const { return static_cast<std::size_t>(info_.width_px) * (heights_ ? 2 : 4); }

  File file_;
  std::string name_;
  PictureInfo info_;
  std::int64_t row_ = 0;
  int passes_ = 1;
  std::vector<std::uint8_t> whole_;
  std::vector<std::uint8_t> samples_;  ///< a row of heights
  std::optional<HeightCoding> heights_;
  std::vector<float> heights_row_;
  char message_[128] = "out of memory";
  png_structp png_ = nullptr;
  png_infop header_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<RowReader>> open_png_rows(File file, std::string name,
                                                 const std::optional<HeightCoding>& heights) {
  auto rows = std::make_unique<PngRows>(std::move(file), std::move(name), heights);
  if (Status opened = rows->open(); !opened) return opened.error();
  return std::unique_ptr<RowReader>(std::move(rows));
}

}  // namespace terrella
