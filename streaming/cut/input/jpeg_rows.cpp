#include <csetjmp>
#include <cstdio>
// jpeglib.h needs size_t and FILE to be declared before it.
#include <jpeglib.h>
// jerror.h needs jpeglib.h.
#include <jerror.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "streaming/cut/input/exif_orientation.h"
#include "streaming/cut/input/row_formats.h"
#include "streaming/cut/input/turned_rows.h"

namespace terrella {
namespace {

/// Limit against files of a few kilobytes with thousands of scans over the whole picture. Real progressive files have
/// about ten.
constexpr int kMaxScans = 100;

/// libjpeg's error state, with the jump target. longjmp jumps over the C frames of its callbacks.
struct ErrorState {
  jpeg_error_mgr manager;
  std::jmp_buf way_out;
  char message[JMSG_LENGTH_MAX];
};

ErrorState* error_state(j_common_ptr codec) { return reinterpret_cast<ErrorState*>(codec->err); }

[[noreturn]] void on_jpeg_error(j_common_ptr codec) {
  ErrorState* state = error_state(codec);
  (*state->manager.format_message)(codec, state->message);
  std::longjmp(state->way_out, 1);
}

/// Treats a warning as an error, because pixels were made up, except for warnings that cameras and editors commonly
/// cause.
void on_message(j_common_ptr codec, int level) {
  if (level >= 0) return;
  const int code = codec->err->msg_code;
  const bool harmless = code == JWRN_EXTRANEOUS_DATA || code == JWRN_ADOBE_XFORM || code == JWRN_JFIF_MAJOR;
  if (!harmless) on_jpeg_error(codec);
}

void on_progress(j_common_ptr codec) {
  const auto* decoder = reinterpret_cast<jpeg_decompress_struct*>(codec);
  if (decoder->input_scan_number <= kMaxScans) return;
  std::snprintf(error_state(codec)->message, JMSG_LENGTH_MAX, "it has more than %d scans", kMaxScans);
  std::longjmp(error_state(codec)->way_out, 1);
}

/// The first APP1 marker with EXIF data. Markers that hold other data, such as XMP, may be many and long.
struct ExifMarker {
  std::size_t size = 0;
  std::array<JOCTET, 65536> bytes{};
};

JOCTET next_byte(j_decompress_ptr decoder) {
  jpeg_source_mgr* source = decoder->src;
  if (source->bytes_in_buffer == 0) static_cast<void>((*source->fill_input_buffer)(decoder));
  --source->bytes_in_buffer;
  return *source->next_input_byte++;
}

boolean on_app1(j_decompress_ptr decoder) {
  auto* exif = static_cast<ExifMarker*>(decoder->client_data);
  const std::size_t high = next_byte(decoder), low = next_byte(decoder);
  const std::size_t length = high << 8 | low;
  if (length < 2) ERREXIT(decoder, JERR_BAD_LENGTH);
  const bool wanted = exif->size == 0;
  for (std::size_t i = 0; i < length - 2; ++i) {
    const JOCTET byte = next_byte(decoder);
    if (wanted) exif->bytes[i] = byte;
  }
  if (wanted && length > 8 && std::memcmp(exif->bytes.data(), "Exif\0", 6) == 0) exif->size = length - 2;
  return TRUE;
}

class JpegRows : public RowReader {
 public:
  JpegRows(File file, std::string name, int eighths)
      : file_(std::move(file)), name_(std::move(name)), eighths_(static_cast<unsigned>(eighths)) {
    decoder_.err = jpeg_std_error(&errors_.manager);
    errors_.manager.error_exit = on_jpeg_error;
    errors_.manager.emit_message = on_message;
    progress_.progress_monitor = on_progress;
  }
  ~JpegRows() override {
    // Safe even if creation failed: libjpeg checks for a memory manager.
    jpeg_destroy_decompress(&decoder_);
  }
  JpegRows(const JpegRows&) = delete;
  JpegRows& operator=(const JpegRows&) = delete;

  [[nodiscard]] Status open() {
    if (!read_header()) return Error{fmt::format("{}: is not a JPEG that can be read: {}", name_, errors_.message)};
    info_ = {.width_px = decoder_.output_width, .height_px = decoder_.output_height, .has_alpha = false};
    if (Status fits = check_picture_size(name_, info_.width_px, info_.height_px); !fits) return fits;
    if (Status can = check_kind(); !can) return can;
    orientation_ = exif_orientation(std::as_bytes(std::span(exif_.bytes.data(), exif_.size)));
    return Done{};
  }

  [[nodiscard]] const PictureInfo& info() const override { return info_; }
  [[nodiscard]] int orientation() const { return orientation_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    // A picture of several scans is decoded here.
    if ((row_ == 0 && !start()) || !read_scanline(rgba.data()))
      return row_error(name_, row_, info_.height_px, errors_.message);
    ++row_;
    return Done{};
  }

 private:
  // Functions that call setjmp contain no objects with destructors.
  bool read_header() {
    if (setjmp(errors_.way_out) != 0) return false;
    jpeg_create_decompress(&decoder_);
    decoder_.progress = &progress_;
    decoder_.client_data = &exif_;
    jpeg_set_marker_processor(&decoder_, JPEG_APP0 + 1, on_app1);
    jpeg_stdio_src(&decoder_, file_.get());
    jpeg_read_header(&decoder_, TRUE);
    decoder_.scale_num = eighths_;
    decoder_.scale_denom = 8;
    jpeg_calc_output_dimensions(&decoder_);
    return true;
  }
  bool start() {
    if (setjmp(errors_.way_out) != 0) return false;
    decoder_.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&decoder_);
    return true;
  }
  bool read_scanline(JSAMPROW row) {
    if (setjmp(errors_.way_out) != 0) return false;
    return jpeg_read_scanlines(&decoder_, &row, 1) == 1;
  }

  [[nodiscard]] Status check_kind() {
    const J_COLOR_SPACE space = decoder_.jpeg_color_space;
    if (space == JCS_CMYK || space == JCS_YCCK) {
      return Error{fmt::format("{}: CMYK is not supported; convert it to RGB", name_)};
    }
    const std::uint64_t held = coefficient_bytes();
    if (held > kMaxHeldBytes) {
      return Error{
          fmt::format("{}: a progressive JPEG of this size needs {} MiB of memory; make it sequential first: jpegtran "
                      "-outfile sequential.jpg {}",
                      name_, held >> 20, name_)};
    }
    return Done{};
  }

  /// Memory for a progressive or multi-scan picture, which libjpeg holds completely, as coefficients.
  [[nodiscard]] std::uint64_t coefficient_bytes() const {
    if (jpeg_has_multiple_scans(const_cast<j_decompress_ptr>(&decoder_)) == FALSE) return 0;
    std::uint64_t blocks = 0;
    for (int i = 0; i < decoder_.num_components; ++i) {
      blocks += std::uint64_t{decoder_.comp_info[i].width_in_blocks} * decoder_.comp_info[i].height_in_blocks;
    }
    return blocks * DCTSIZE2 * sizeof(JCOEF);
  }

  File file_;
  std::string name_;
  unsigned eighths_;
  PictureInfo info_;
  std::int64_t row_ = 0;
  int orientation_ = 1;
  ExifMarker exif_;
  ErrorState errors_{};
  jpeg_progress_mgr progress_{};
  jpeg_decompress_struct decoder_{};
};

}  // namespace

Result<std::unique_ptr<RowReader>> open_jpeg_rows(File file, std::string name, int eighths) {
  auto rows = std::make_unique<JpegRows>(std::move(file), name, eighths);
  if (Status opened = rows->open(); !opened) return opened.error();
  const int orientation = rows->orientation();
  return upright_rows(std::move(rows), orientation, name);
}

}  // namespace terrella
