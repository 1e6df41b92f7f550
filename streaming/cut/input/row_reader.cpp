#include "streaming/cut/input/row_reader.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "codecs/image.h"
#include "streaming/cut/input/row_formats.h"
#include "streaming/file_bytes.h"
#include "streaming/raster/picture_kind.h"

namespace terrella {
namespace {

/// Repeats the half row that is missing at the south pole of a planet of odd width.
class PaddedRows : public RowReader {
 public:
  PaddedRows(std::unique_ptr<RowReader> reader, std::int64_t rows)
      : reader_(std::move(reader)), info_(reader_->info()) {
    info_.height_px = rows;
  }
  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (row_ + 1 < reader_->info().height_px) {
      ++row_;
      return reader_->read_row(rgba);
    }
    if (Status read = read_last(); !read) return read;
    ++row_;
    std::memcpy(rgba.data(), last_.data(), last_.size());
    return Done{};
  }

  [[nodiscard]] Status skip_rows(std::int64_t rows) override {
    const std::int64_t before_last = std::max<std::int64_t>(0, reader_->info().height_px - 1 - row_);
    row_ += rows;
    return reader_->skip_rows(std::min(rows, before_last));
  }

 private:
  Status read_last() {
    if (!last_.empty()) return Done{};
    last_.resize(static_cast<std::size_t>(info_.width_px) * 4);
    return reader_->read_row(last_);
  }

  std::unique_ptr<RowReader> reader_;
  PictureInfo info_;
  std::int64_t row_ = 0;
  std::vector<std::uint8_t> last_;
};

}  // namespace

Status RowReader::skip_rows(std::int64_t rows) {
  std::vector<std::uint8_t> row(static_cast<std::size_t>(info().width_px) * 4);
  for (std::int64_t i = 0; i < rows; ++i) {
    if (Status read = read_row(row); !read) return read;
  }
  return Done{};
}

std::unique_ptr<RowReader> with_rows(std::unique_ptr<RowReader> reader, std::int64_t rows) {
  if (reader->info().height_px == rows) return reader;
  return std::make_unique<PaddedRows>(std::move(reader), rows);
}

Status check_picture_size(const std::string& name, std::int64_t width_px, std::int64_t height_px) {
  if (width_px < 1 || height_px < 1) return Error{fmt::format("{}: the picture has no pixels", name)};
  if (width_px > kMaxPictureSide_px || height_px > kMaxPictureSide_px) {
    return Error{fmt::format("{}: {}x{} pixels are too many; a side may have at most {}", name, width_px, height_px,
                             kMaxPictureSide_px)};
  }
  return Done{};
}

Error row_error(const std::string& name, std::int64_t row, std::int64_t rows, std::string_view why) {
  return Error{fmt::format("{}: row {} of {} cannot be read: {}; the file is truncated or damaged, get it again", name,
                           row + 1, rows, why)};
}

Error refuse_heights(const std::string& name) {
  return Error{
      fmt::format("{}: heights are read from PNG of one channel of 16 bits, or TIFF without colours; convert it "
                  "(gdal_translate -b 1)",
                  name)};
}

namespace {

Result<std::unique_ptr<RowReader>> open_any(const std::filesystem::path& path,
                                            const std::optional<HeightCoding>& heights, const CodingOptions& choice,
                                            int jobs) {
  const std::string name = path.string();
  if (Status regular = check_regular(path); !regular) return regular.error();
  if (file_of(path) != path) return open_raster_rows(name, heights, choice, jobs);
  File file(std::fopen(name.c_str(), "rb"));
  if (!file && errno == ENOENT) return Error{fmt::format("{}: no such file", name)};
  if (!file) return Error{fmt::format("{}: cannot be opened: {}", name, std::strerror(errno))};
  std::array<char, 64> bytes{};
  const std::string_view head(bytes.data(), std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (head.empty()) return Error{fmt::format("{}: is empty; download or copy it again", name)};
  std::rewind(file.get());
  const ImageFormat format = sniff_format(std::as_bytes(std::span(head)));
  if (format != ImageFormat::unknown && choice.composite) {
    return Error{
        fmt::format("{}: ‹bands› chooses bands of a TIFF; leave it out, or convert the picture "
                    "(gdal_translate -of COG)",
                    name)};
  }
  if (format == ImageFormat::png) return open_png_rows(std::move(file), name, heights);
  if (format != ImageFormat::unknown && heights) return refuse_heights(name);
  if (format == ImageFormat::jpeg) return open_jpeg_rows(std::move(file), name);
  if (format == ImageFormat::webp) return open_webp_rows(name);
  if (picture_kind(path) == PictureKind::raster) return open_raster_rows(name, heights, choice, jobs);
  return Error{
      fmt::format("{}: is no picture that is read: neither JPEG, PNG or WebP nor a raster of GDAL's formats", name)};
}

}  // namespace

Result<std::unique_ptr<RowReader>> open_rows(const std::filesystem::path& path, const CodingOptions& choice, int jobs) {
  return open_any(path, {}, choice, jobs);
}

Result<std::unique_ptr<RowReader>> open_height_rows(const std::filesystem::path& path, const HeightCoding& coding,
                                                    int jobs) {
  return open_any(path, coding, {}, jobs);
}

}  // namespace terrella
