#include "streaming/cut/input/turned_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <vector>

#include "streaming/georeference/side_files.h"
#include "streaming/other_formats.h"

namespace terrella {
namespace {

/// Stored position of the upright picture's pixel: mirrored stored columns or rows, and rows that become columns.
struct Turn {
  bool mirror_columns = false;
  bool mirror_rows = false;
  bool transpose = false;
  const char* jpegtran;
};
/// By EXIF orientation, from 1.
constexpr std::array<Turn, 8> kTurns = {{{false, false, false, ""},
                                         {true, false, false, "-flip horizontal"},
                                         {true, true, false, "-rotate 180"},
                                         {false, true, false, "-flip vertical"},
                                         {false, false, true, "-transpose"},
                                         {false, true, true, "-rotate 90"},
                                         {true, true, true, "-transverse"},
                                         {true, false, true, "-rotate 270"}}};

/// An opaque picture is held without its alpha.
std::size_t held_bytes(const PictureInfo& info) { return info.has_alpha ? 4 : 3; }

PictureInfo turned_info(PictureInfo info, int orientation, const Turn& turn) {
  if (turn.transpose) std::swap(info.width_px, info.height_px);
  info.orientation = orientation;
  return info;
}

class MirroredRows : public RowReader {
 public:
  MirroredRows(std::unique_ptr<RowReader> stored, const PictureInfo& info) : stored_(std::move(stored)), info_(info) {}
  [[nodiscard]] const PictureInfo& info() const override { return info_; }
  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (Status read = stored_->read_row(rgba); !read) return read;
    const auto width = static_cast<std::size_t>(info_.width_px);
    for (std::size_t left = 0, right = width - 1; left < right; ++left, --right) {
      std::swap_ranges(&rgba[left * 4], &rgba[left * 4] + 4, &rgba[right * 4]);
    }
    return Done{};
  }

 private:
  std::unique_ptr<RowReader> stored_;
  PictureInfo info_;
};

class TurnedRows : public SeekingRows {
 public:
  TurnedRows(std::unique_ptr<RowReader> reader, const PictureInfo& info, const Turn& turn)
      : reader_(std::move(reader)),
        stored_(reader_->info()),
        info_(info),
        turn_(turn),
        pixel_bytes_(held_bytes(info)) {}

  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    if (held_.empty()) {
      if (Status held = hold(); !held) return held;
    }
    for (std::int64_t x = 0; x < info_.width_px; ++x) {
      std::uint8_t* to = &rgba[static_cast<std::size_t>(x) * 4];
      to[3] = 255;
      std::memcpy(to, stored_pixel(turn_.transpose ? row_ : x, turn_.transpose ? x : row_), pixel_bytes_);
    }
    ++row_;
    return Done{};
  }

 private:
  [[nodiscard]] Status hold() {
    const auto width = static_cast<std::size_t>(stored_.width_px);
    held_.resize(width * static_cast<std::size_t>(stored_.height_px) * pixel_bytes_);
    std::vector<std::uint8_t> row(width * 4);
    std::uint8_t* to = held_.data();
    for (std::int64_t y = 0; y < stored_.height_px; ++y) {
      if (Status read = reader_->read_row(row); !read) return read;
      for (std::size_t x = 0; x < width; ++x, to += pixel_bytes_) std::memcpy(to, &row[x * 4], pixel_bytes_);
    }
    reader_.reset();
    return Done{};
  }

  [[nodiscard]] const std::uint8_t* stored_pixel(std::int64_t column, std::int64_t row) const {
    if (turn_.mirror_columns) column = stored_.width_px - 1 - column;
    if (turn_.mirror_rows) row = stored_.height_px - 1 - row;
    return &held_[static_cast<std::size_t>(row * stored_.width_px + column) * pixel_bytes_];
  }

  std::unique_ptr<RowReader> reader_;  ///< null once the picture is held
  PictureInfo stored_;
  PictureInfo info_;
  Turn turn_;
  std::size_t pixel_bytes_;
  std::vector<std::uint8_t> held_;
};

}  // namespace

Result<std::unique_ptr<RowReader>> upright_rows(std::unique_ptr<RowReader> stored, int orientation,
                                                const std::string& name) {
  assert(orientation >= 1 && orientation <= 8);
  if (orientation == 1 || is_placed_as_stored(name)) return stored;
  const Turn& turn = kTurns.at(static_cast<std::size_t>(orientation - 1));
  const PictureInfo from = stored->info();
  const PictureInfo info = turned_info(from, orientation, turn);
  if (orientation == 2) return std::unique_ptr<RowReader>(std::make_unique<MirroredRows>(std::move(stored), info));
  const std::uint64_t held = static_cast<std::uint64_t>(from.width_px * from.height_px) * held_bytes(from);
  if (held > kMaxHeldBytes) {
    return Error{
        fmt::format("{}: its EXIF orientation turns it, which needs {} MiB of memory; turn the file first: jpegtran {} "
                    "-outfile turned.jpg {}",
                    name, held >> 20, turn.jpegtran, shell_word(name))};
  }
  return std::unique_ptr<RowReader>(std::make_unique<TurnedRows>(std::move(stored), info, turn));
}

}  // namespace terrella
