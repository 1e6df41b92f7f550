#include "streaming/raster/rows/block_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "streaming/file_bytes.h"

namespace terrella {
namespace {

/// Most memory for the row of blocks that is being filled, bytes.
constexpr std::uint64_t kMaxBandBytes = 32ULL << 20;
constexpr std::int64_t kMostBlockHeight_px = 256;
constexpr std::int64_t kLeastBlockHeight_px = 16;

/// Calls pread or pwrite until all bytes have been moved. False on a fault, and where the file ends.
template <class Byte, class Call>
bool move_all(Call call, int file, Byte* bytes, std::size_t size, std::uint64_t offset) {
  while (size > 0) {
    const ssize_t done = call(file, bytes, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    size -= static_cast<std::size_t>(done);
    offset += static_cast<std::uint64_t>(done);
  }
  return true;
}

/// Copies pixels of 4 bytes, without the last byte if only 3 are stored.
void store_pixels(const std::uint8_t* from, std::size_t count, std::size_t pixel_bytes, std::uint8_t* to) {
  if (pixel_bytes == 4) {
    std::memcpy(to, from, 4 * count);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) std::memcpy(to + 3 * i, from + 4 * i, 3);
}

}  // namespace

BlockStore::BlockStore(const StoredPixels& pixels, std::filesystem::path folder, NextRow next_row)
    : pixels_(pixels), folder_(std::move(folder)), next_row_(std::move(next_row)) {
  const std::uint64_t row_bytes = static_cast<std::uint64_t>(columns()) * kBlockWidth_px * pixels_.pixel_bytes;
  block_height_px_ =
      std::clamp(static_cast<std::int64_t>(kMaxBandBytes / row_bytes), kLeastBlockHeight_px, kMostBlockHeight_px);
  if (in_memory()) in_memory_.resize(static_cast<std::size_t>(bands()));
}

BlockStore::~BlockStore() {
  if (file_ >= 0) ::close(file_);
}

std::size_t BlockStore::block_bytes() const {
  return static_cast<std::size_t>(kBlockWidth_px * block_height_px_) * pixels_.pixel_bytes;
}

bool BlockStore::in_memory() const {
  return static_cast<std::uint64_t>(pixels_.width_px * pixels_.height_px) * pixels_.pixel_bytes <= kMaxStoredBytes;
}

Status BlockStore::open_file() {
  const std::uint64_t needed = static_cast<std::uint64_t>(bands() * columns()) * block_bytes();
  struct statvfs facts {};
  if (::statvfs(folder_.c_str(), &facts) == 0 && std::uint64_t{facts.f_bavail} * facts.f_frsize < needed) {
    return Error{
        fmt::format("{}: has no room for the {} MiB of a picture that is read row by row; make room, set TMPDIR "
                    "to another folder, or convert the picture (gdal_translate -of COG)",
                    folder_.string(), needed >> 20)};
  }
  std::string name = (folder_ / "terrella-rows-XXXXXX").string();
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) return Error{fmt::format("{}: no file can be made in it: {}", folder_.string(), std::strerror(errno))};
  // The file lives until it is closed, and nothing is left behind if the program is killed.
  ::unlink(name.c_str());
  return Done{};
}

Result<std::vector<std::uint8_t>> BlockStore::read(std::int64_t column, std::int64_t row) {
  if (row >= filled_.load(std::memory_order_acquire)) {
    if (Status filled = fill_to(row); !filled) return filled.error();
  }
  const auto index = static_cast<std::size_t>(column) * block_bytes();
  std::vector<std::uint8_t> stored;
  const std::uint8_t* from = nullptr;
  if (in_memory()) {
    from = in_memory_[static_cast<std::size_t>(row)].data() + index;
  } else {
    stored.resize(block_bytes());
    const std::uint64_t offset =
        static_cast<std::uint64_t>(row * columns()) * block_bytes() + static_cast<std::uint64_t>(index);
    if (!move_all(::pread, file_, stored.data(), stored.size(), offset)) {
      return Error{
          fmt::format("{}: a temporary file in it cannot be read: {}", folder_.string(), std::strerror(errno))};
    }
    from = stored.data();
  }
  if (pixels_.pixel_bytes == 4) return std::vector<std::uint8_t>(from, from + block_bytes());
  std::vector<std::uint8_t> rgba(block_bytes() / 3 * 4, 255);
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) std::memcpy(rgba.data() + 4 * i, from + 3 * i, 3);
  return rgba;
}

Status BlockStore::fill_to(std::int64_t row) {
  const std::lock_guard lock(mutex_);
  if (!in_memory() && file_ < 0 && !failed_) {
    if (Status opened = open_file(); !opened) failed_ = opened.error();
  }
  while (!failed_ && filled_.load(std::memory_order_relaxed) <= row) {
    const std::int64_t band = filled_.load(std::memory_order_relaxed);
    Status filled = fill_band(band);
    if (filled) filled = write_band(band);
    if (!filled) {
      failed_ = filled.error();
    } else {
      filled_.store(band + 1, std::memory_order_release);
    }
  }
  return failed_ && filled_.load(std::memory_order_relaxed) <= row ? Status(*failed_) : Done{};
}

/// Reads a row of blocks from the picture.
Status BlockStore::fill_band(std::int64_t row) {
  band_.assign(static_cast<std::size_t>(columns()) * block_bytes(), 0);
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(pixels_.width_px) * 4);
  const std::int64_t rows = std::min(block_height_px_, pixels_.height_px - row * block_height_px_);
  for (std::int64_t y = 0; y < rows; ++y) {
    if (Status read = next_row_(pixels); !read) return read;
    for (std::int64_t column = 0; column < columns(); ++column) {
      const std::int64_t x = column * kBlockWidth_px;
      const auto count = static_cast<std::size_t>(std::min<std::int64_t>(kBlockWidth_px, pixels_.width_px - x));
      std::uint8_t* to = band_.data() + static_cast<std::size_t>(column) * block_bytes() +
                         static_cast<std::size_t>(y * kBlockWidth_px) * pixels_.pixel_bytes;
      store_pixels(pixels.data() + 4 * x, count, pixels_.pixel_bytes, to);
    }
  }
  return Done{};
}

Status BlockStore::write_band(std::int64_t row) {
  if (in_memory()) {
    in_memory_[static_cast<std::size_t>(row)] = std::move(band_);
    return Done{};
  }
  const std::uint64_t offset = static_cast<std::uint64_t>(row * columns()) * block_bytes();
  if (move_all(::pwrite, file_, band_.data(), band_.size(), offset)) return Done{};
  return Error{
      fmt::format("{}: a temporary file in it cannot be written: {}", folder_.string(), why_not_written(errno))};
}

}  // namespace terrella
