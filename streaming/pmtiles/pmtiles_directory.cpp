#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "streaming/pmtiles/pmtiles_format.h"

namespace terrella {
namespace {

constexpr std::size_t kMinEntryBytes = 4;  // four numbers of a byte

/// Reads numbers of 7 bits a byte, the lowest first. The first fault ends it; later numbers are 0.
class VarintReader {
 public:
  explicit VarintReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::uint64_t next(std::uint64_t most) {
    std::uint64_t number = 0;
    for (int shift = 0; fault_ == nullptr; shift += 7) {
      if (rest_.empty()) {
        fail("it ends within a number");
        break;
      }
      const auto byte = std::to_integer<std::uint64_t>(rest_.front());
      rest_ = rest_.subspan(1);
      const std::uint64_t bits = byte & 0x7F;
      number |= bits << shift;
      if (shift > 56 || number > most) fail("a number in it is too large");
      if (byte < 0x80) break;
    }
    return fault_ == nullptr ? number : 0;
  }
  void fail(const char* why) {
    if (fault_ == nullptr) fault_ = why;
  }
  [[nodiscard]] const char* fault() const { return fault_; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
  const char* fault_ = nullptr;
};

void append_number(std::vector<std::byte>& bytes, std::uint64_t number) {
  for (; number >= 0x80; number >>= 7) bytes.push_back(static_cast<std::byte>((number & 0x7F) | 0x80));
  bytes.push_back(static_cast<std::byte>(number));
}

constexpr std::uint64_t kMost32 = std::numeric_limits<std::uint32_t>::max();
/// Highest tile number and offset. Sums of a few of them do not overflow.
constexpr std::uint64_t kMostNumber = std::uint64_t{1} << 62;

void read_tiles(VarintReader& numbers, PmtilesDirectory& directory) {
  std::uint64_t tile = 0;
  for (PmtilesEntry& entry : directory) {
    const std::uint64_t step = numbers.next(kMostNumber);
    if (step == 0 && &entry != directory.data()) numbers.fail("its tiles are out of order");
    if (step > kMostNumber - tile) numbers.fail("a number in it is too large");
    if (numbers.fault() != nullptr) return;
    tile += step;
    entry.tile = tile;
  }
}

void read_offsets(VarintReader& numbers, PmtilesDirectory& directory) {
  std::uint64_t end = 0;
  for (PmtilesEntry& entry : directory) {
    const std::uint64_t value = numbers.next(kMostNumber);
    if (value == 0 && &entry == directory.data()) numbers.fail("its first offset continues nothing");
    entry.offset = value == 0 ? end : value - 1;
    end = entry.offset + entry.length;
    if (end > kMostNumber) numbers.fail("a number in it is too large");
    if (numbers.fault() != nullptr) return;
  }
}

void check_entries(VarintReader& numbers, const PmtilesDirectory& directory) {
  for (std::size_t i = 0; i < directory.size(); ++i) {
    if (directory[i].length == 0) numbers.fail("it lists a tile of no bytes");
    if (i > 0 && directory[i].tile - directory[i - 1].tile < directory[i - 1].run) numbers.fail("its runs overlap");
  }
}

/// zlib's code for gzip alone, with the largest window.
constexpr int kGzipWindow = 16 + MAX_WBITS;

Result<std::vector<std::byte>> gunzip(std::span<const std::byte> bytes, std::size_t max_bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, kGzipWindow) != Z_OK) return Error{"gzip: out of memory"};
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::vector<std::byte> out;
  int code = Z_OK;
  while (code == Z_OK && out.size() <= max_bytes) {
    const std::size_t known = out.size();
    out.resize(std::min(std::max<std::size_t>(2 * known, 4 * bytes.size() + 1024), max_bytes + 1));
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + known);
    stream.avail_out = static_cast<uInt>(out.size() - known);
    code = inflate(&stream, Z_NO_FLUSH);
    out.resize(out.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (out.size() > max_bytes) return Error{fmt::format("gzip: over {} bytes after decompression", max_bytes)};
  if (code != Z_STREAM_END) return Error{"gzip: the data is truncated or damaged"};
  return out;
}

}  // namespace

Result<std::vector<std::byte>> unpack(std::span<const std::byte> bytes, PmtilesCompression compression,
                                      std::size_t max_bytes) {
  if (compression == PmtilesCompression::gzip) return gunzip(bytes, max_bytes);
  if (bytes.size() > max_bytes) return Error{fmt::format("over {} bytes", max_bytes)};
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

Result<PmtilesDirectory> parse_pmtiles_directory(std::span<const std::byte> bytes) {
  VarintReader numbers(bytes);
  const std::uint64_t count = numbers.next(kMost32);
  if (numbers.fault() == nullptr && count == 0) numbers.fail("it lists nothing");
  if (count > numbers.left() / kMinEntryBytes) numbers.fail("it ends before its entries do");
  PmtilesDirectory directory;
  if (numbers.fault() == nullptr) {
    directory.resize(count);
    read_tiles(numbers, directory);
    for (PmtilesEntry& entry : directory) entry.run = static_cast<std::uint32_t>(numbers.next(kMost32));
    for (PmtilesEntry& entry : directory) entry.length = static_cast<std::uint32_t>(numbers.next(kMost32));
    read_offsets(numbers, directory);
  }
  if (numbers.fault() == nullptr) check_entries(numbers, directory);
  if (numbers.fault() != nullptr) return Error{fmt::format("a directory is damaged: {}", numbers.fault())};
  return directory;
}

std::vector<std::byte> pmtiles_directory_bytes(const PmtilesDirectory& directory) {
  std::vector<std::byte> bytes;
  bytes.reserve(8 * directory.size() + 16);
  append_number(bytes, directory.size());
  std::uint64_t tile = 0;
  for (const PmtilesEntry& entry : directory) append_number(bytes, entry.tile - std::exchange(tile, entry.tile));
  for (const PmtilesEntry& entry : directory) append_number(bytes, entry.run);
  for (const PmtilesEntry& entry : directory) append_number(bytes, entry.length);
  std::optional<std::uint64_t> end;
  for (const PmtilesEntry& entry : directory) {
    append_number(bytes, entry.offset == end ? 0 : entry.offset + 1);
    end = entry.offset + entry.length;
  }
  return bytes;
}

Result<std::vector<std::byte>> pack(std::span<const std::byte> bytes) {
  constexpr int kMemory = 9;
  z_stream stream{};
  const Error no_memory{"gzip: out of memory"};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
    return no_memory;
  }
  std::vector<std::byte> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int code = deflate(&stream, Z_FINISH);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) return no_memory;
  return out;
}

const PmtilesEntry* find_entry(const PmtilesDirectory& directory, std::uint64_t tile) {
  const auto after = std::ranges::upper_bound(directory, tile, {}, &PmtilesEntry::tile);
  if (after == directory.begin()) return nullptr;
  const PmtilesEntry& entry = *(after - 1);
  return entry.run == 0 || tile - entry.tile < entry.run ? &entry : nullptr;
}

}  // namespace terrella
