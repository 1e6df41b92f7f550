#include "streaming/cut/input/watched_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace terrella {
namespace {

class WatchedRows : public RowReader {
 public:
  WatchedRows(std::unique_ptr<RowReader> rows, const CutOptions& options)
      : rows_(std::move(rows)), watch_(*options.watch), progress_(options.progress), output_(options.output) {}

  [[nodiscard]] const PictureInfo& info() const override { return rows_->info(); }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (Status read = rows_->read_row(rgba); !read) return read;
    if (row_ % watch_.row_step == 0) watch_.row_read(row_, rgba);
    ++row_;
    return Done{};
  }

  [[nodiscard]] Status skip_rows(std::int64_t rows) override {
    std::vector<std::uint8_t> row(static_cast<std::size_t>(info().width_px) * 4);
    for (const std::int64_t end = row_ + rows; row_ < end;) {
      if (progress_ && !progress_(row_, info().height_px)) {
        return Error{fmt::format("{}: cutting was stopped", output_.string())};
      }
      if (Status read = read_row(row); !read) return read;
      const std::int64_t between = std::min(watch_.row_step - 1, end - row_);
      if (Status skipped = rows_->skip_rows(between); !skipped) return skipped;
      row_ += between;
    }
    return Done{};
  }

 private:
  std::unique_ptr<RowReader> rows_;
  const CutWatch& watch_;
  const std::function<bool(std::int64_t, std::int64_t)>& progress_;
  const std::filesystem::path& output_;
  std::int64_t row_ = 0;
};

}  // namespace

std::unique_ptr<RowReader> watched_rows(std::unique_ptr<RowReader> rows, const CutOptions& options) {
  return std::make_unique<WatchedRows>(std::move(rows), options);
}

}  // namespace terrella
