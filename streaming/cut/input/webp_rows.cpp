#include <cstring>
#include <vector>

#include "codecs/image.h"
#include "codecs/webp_codec.h"
#include "streaming/cut/input/exif_orientation.h"
#include "streaming/cut/input/row_formats.h"
#include "streaming/cut/input/turned_rows.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

/// Longest WebP file that is read. A lossless photograph of 16383² pixels has some 500 MB.
constexpr std::size_t kMaxWebpFileBytes = 512UL << 20;

/// libwebp decodes whole pictures: this reader holds all pixels, at most 1 GiB for the largest picture of the format.
class WebpRows : public SeekingRows {
 public:
  WebpRows(std::string name, std::vector<std::byte> bytes, const WebpHeader& header)
      : name_(std::move(name)),
        bytes_(std::move(bytes)),
        info_{.width_px = header.size.width_px, .height_px = header.size.height_px, .has_alpha = header.has_alpha} {}

  [[nodiscard]] const PictureInfo& info() const override { return info_; }
  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (!bytes_.empty()) {
      if (Status decoded = decode(); !decoded) return decoded;
    }
    const std::size_t row_bytes = static_cast<std::size_t>(info_.width_px) * 4;
    std::memcpy(rgba.data(), &image_.rgba[static_cast<std::size_t>(row_++) * row_bytes], row_bytes);
    return Done{};
  }

 private:
  [[nodiscard]] Status decode() {
    Result<Image> image = decode_webp(bytes_, {.max_side_px = kMaxWebpSide_px, .max_bytes = kMaxHeldBytes});
    if (!image) return row_error(name_, row_, info_.height_px, image.error().message);
    image_ = *std::move(image);
    bytes_ = {};
    return Done{};
  }

  std::string name_;
  std::vector<std::byte> bytes_;  ///< empty once the picture is decoded
  Image image_;
  PictureInfo info_;
};

}  // namespace

Result<std::unique_ptr<RowReader>> open_webp_rows(const std::string& name) {
  static_assert(std::uint64_t{kMaxWebpSide_px} * kMaxWebpSide_px * 4 <= kMaxHeldBytes);
  auto bytes = read_file(name, kMaxWebpFileBytes);
  if (!bytes) return Error{bytes.error().message};
  const Result<WebpHeader> header = webp_header(*bytes);
  if (!header) return Error{fmt::format("{}: is not a WebP that can be read: {}", name, header.error().message)};
  const int orientation = exif_orientation_of_webp(*bytes);
  return upright_rows(std::make_unique<WebpRows>(name, *std::move(bytes), *header), orientation, name);
}

}  // namespace terrella
