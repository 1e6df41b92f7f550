#include "streaming/cut/input/mosaic_rows.h"

#include <fmt/format.h>

#include <algorithm>

namespace terrella {
namespace {

class MosaicRows : public RowReader {
 public:
  MosaicRows(std::vector<MosaicPart> parts, MosaicLayout layout, const PictureInfo& info, OpenRows open)
      : parts_(std::move(parts)), layout_(std::move(layout)), info_(info), open_(std::move(open)) {}

  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (Status opened = open_row_of_parts(); !opened) return opened;
    std::size_t at = 0;
    for (const auto& reader : readers_) {
      const std::size_t bytes = static_cast<std::size_t>(reader->info().width_px) * 4;
      if (Status read = reader->read_row(rgba.subspan(at, bytes)); !read) return read;
      at += bytes;
    }
    pass(1);
    return Done{};
  }

  [[nodiscard]] Status skip_rows(std::int64_t rows) override {
    while (rows > 0) {
      const std::int64_t here = std::min(rows, layout_.rows[row_of_parts_].height_px - in_part_);
      const bool all = in_part_ == 0 && here == layout_.rows[row_of_parts_].height_px;
      // Rows of parts that are skipped completely are not opened.
      if (!all) {
        if (Status opened = open_row_of_parts(); !opened) return opened;
        for (const auto& reader : readers_) {
          if (Status skipped = reader->skip_rows(here); !skipped) return skipped;
        }
      }
      pass(here);
      rows -= here;
    }
    return Done{};
  }

 private:
  void pass(std::int64_t rows) {
    in_part_ += rows;
    if (in_part_ < layout_.rows[row_of_parts_].height_px) return;
    readers_.clear();
    in_part_ = 0;
    ++row_of_parts_;
  }

  Status open_row_of_parts() {
    if (!readers_.empty()) return Done{};
    for (const std::size_t index : layout_.rows[row_of_parts_].parts) {
      const MosaicPart& part = parts_[index];
      auto reader = open_(part.path);
      if (!reader) return reader.error();
      const PictureInfo& now = (*reader)->info();
      if (now.width_px != part.width_px || now.height_px != part.height_px) {
        return Error{fmt::format("{}: has changed while it was being cut", part.path.string())};
      }
      readers_.push_back(*std::move(reader));
    }
    return Done{};
  }

  std::vector<MosaicPart> parts_;
  MosaicLayout layout_;
  PictureInfo info_;
  OpenRows open_;
  std::size_t row_of_parts_ = 0;
  std::int64_t in_part_ = 0;  ///< rows done in this row of parts
  std::vector<std::unique_ptr<RowReader>> readers_;
};

}  // namespace

std::unique_ptr<RowReader> make_mosaic_rows(std::vector<MosaicPart> parts, MosaicLayout layout, const PictureInfo& info,
                                            OpenRows open) {
  return std::make_unique<MosaicRows>(std::move(parts), std::move(layout), info, std::move(open));
}

}  // namespace terrella
