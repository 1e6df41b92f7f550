#include "streaming/cut/input/rolled_rows.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <vector>

namespace terrella {
namespace {

class RolledRows : public RowReader {
 public:
  RolledRows(std::unique_ptr<RowReader> reader, std::int64_t first_column, std::int64_t turn_px, bool heights)
      : reader_(std::move(reader)), info_(reader_->info()), heights_(heights) {
    assert(info_.width_px <= turn_px && first_column >= 0 && first_column < turn_px);
    row_.resize(static_cast<std::size_t>(info_.width_px) * 4);
    first_ = static_cast<std::size_t>(first_column) * 4;
    info_.has_alpha = info_.has_alpha || info_.width_px < turn_px;
    info_.width_px = turn_px;
  }
  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> pixels) override {
    if (Status read = reader_->read_row(row_); !read) return read;
    if (row_.size() < pixels.size()) clear(pixels);
    const std::size_t before = std::min(row_.size(), pixels.size() - first_);
    std::memcpy(pixels.data() + first_, row_.data(), before);
    std::memcpy(pixels.data(), row_.data() + before, row_.size() - before);
    return Done{};
  }
  [[nodiscard]] Status skip_rows(std::int64_t rows) override { return reader_->skip_rows(rows); }

 private:
  void clear(std::span<std::uint8_t> pixels) const {
    std::ranges::fill(pixels, std::uint8_t{0});
    if (!heights_) return;
    constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < pixels.size(); i += 4) std::memcpy(pixels.data() + i, &kUnknown, sizeof(kUnknown));
  }

  std::unique_ptr<RowReader> reader_;
  PictureInfo info_;
  bool heights_;
  std::size_t first_ = 0;  ///< bytes before the reader's first column
  std::vector<std::uint8_t> row_;
};

}  // namespace

std::unique_ptr<RowReader> rolled_rows(std::unique_ptr<RowReader> reader, std::int64_t first_column,
                                       std::int64_t turn_px, bool heights) {
  return std::make_unique<RolledRows>(std::move(reader), first_column, turn_px, heights);
}

}  // namespace terrella
