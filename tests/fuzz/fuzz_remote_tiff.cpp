#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "streaming/remote_tiff/remote_tiff.h"

namespace {

using terrella::ByteRange;
using terrella::CacheRecord;
using terrella::TileId;

/// Parts of the input as a server would have sent them: some are missing, some end early, some are other bytes.
class FuzzedParts : public terrella::TileCache {
 public:
  FuzzedParts(const std::uint8_t* data, std::size_t size, std::uint8_t faults)
      : data_(reinterpret_cast<const std::byte*>(data)), size_(size), faults_(faults) {}

  [[nodiscard]] const terrella::TileSetInfo& info() const override { return info_; }
  [[nodiscard]] std::filesystem::path set_aside() const override { return {}; }
  [[nodiscard]] terrella::Result<std::optional<CacheRecord>> find(const TileId& id) override {
    if (id.x < 0) return std::optional<CacheRecord>();
    const std::uint64_t offset = (static_cast<std::uint64_t>(id.x) << 32) + static_cast<std::uint64_t>(id.y);
    if (offset >= size_) return std::optional<CacheRecord>();
    const std::size_t fault = offset == 0 ? 0 : (offset * 31 + faults_) % 16;
    if (fault == 1 && faults_ != 0) return std::optional<CacheRecord>();
    CacheRecord record;
    const std::size_t most = id.level == 0 ? std::size_t{32768} : size_;
    std::size_t length = std::min(size_ - offset, most);
    if (fault == 2 && faults_ != 0) length /= 2;
    record.bytes.assign(data_ + offset, data_ + offset + length);
    if (fault == 3 && faults_ != 0 && length > 0) record.bytes[length / 2] ^= std::byte{0x55};
    return std::optional(std::move(record));
  }
  [[nodiscard]] terrella::Result<std::optional<CacheRecord>> peek(const TileId& id) override { return find(id); }
  void store(const TileId&, CacheRecord, std::function<void(const terrella::StoreStatus&)>) override {}
  void renew(const TileId&, std::int64_t, std::optional<std::int64_t>,
             std::function<void(const terrella::StoreStatus&)>) override {}
  void pin(const TileId&, std::int64_t, bool) override {}
  [[nodiscard]] terrella::Status flush() override { return terrella::Done{}; }
  [[nodiscard]] terrella::CacheCounts counts() const override { return {}; }

 private:
  const std::byte* data_;
  const std::size_t size_;
  const std::uint8_t faults_;
  terrella::TileSetInfo info_;
};

/// Lends a block's bytes as the network would bring them, whatever their length, and decodes it.
void read_block(terrella::RemoteFile& file, FuzzedParts& parts, terrella::RemoteTiff& raster, const TileId& block) {
  const auto spans = raster.spans(block);
  if (!spans && spans.error().why.empty()) std::abort();
  auto tile = raster.read(block);
  std::vector<terrella::FilePiece> pieces;
  for (const ByteRange& span : spans ? *spans : std::vector<ByteRange>()) {
    const auto part = parts.find(terrella::RangeCache::span_id(span));
    if (!part || !*part) return;
    std::vector<std::byte> bytes = (*part)->bytes;
    bytes.resize(std::min<std::size_t>(bytes.size(), span.length));
    pieces.push_back({span.offset, std::make_shared<const std::vector<std::byte>>(std::move(bytes))});
  }
  const terrella::RemoteFile::Loan loan(file, std::move(pieces));
  if (!tile) return;
  const bool good =
      tile->make_numbers ? static_cast<bool>(tile->make_numbers()) : static_cast<bool>(tile->make_picture());
  static_cast<void>(good);
}

void read_some(terrella::RemoteFile& file, FuzzedParts& parts, terrella::RemoteTiff& raster) {
  const auto& levels = raster.info().levels;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const terrella::RasterLevel& level = levels[i];
    if (level.width_px < 1 || level.height_px < 1 || level.block_width_px < 1 || level.block_height_px < 1)
      std::abort();
    const bool is_small = level.width_px * level.height_px < 1 << 20;
    read_block(file, parts, raster, {.level = static_cast<int>(i)});
    if (!is_small) continue;
    read_block(file, parts, raster,
               {.level = static_cast<int>(i),
                .x = (level.width_px - 1) / level.block_width_px,
                .y = (level.height_px - 1) / level.block_height_px});
  }
}

}  // namespace

/// Whatever directories, tables and answers a server sends, a TIFF gives blocks or an error. The first byte chooses
/// which parts of the file are missing, end early or are damaged.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const auto parts = std::make_shared<FuzzedParts>(data + 1, size - 1, data[0]);
  const terrella::Url url("http://127.0.0.1/a.tif");
  terrella::RemoteFileOptions options{.url = url, .offline = true};
  options.held_key = terrella::range_cache_key(url, {.etag = "\"1\"", .last_modified = {}, .file_bytes = size - 1});
  options.open_cache = [&parts](const std::string&) { return std::shared_ptr<terrella::TileCache>(parts); };
  const auto file = terrella::RemoteFile::open(options);
  if (!file) return 0;
  for (const bool heights : {false, true}) {
    auto pyramid = terrella::open_remote_raster(**file);
    if (!pyramid && pyramid.error().message.empty()) std::abort();
    if (!pyramid) return 0;
    terrella::RasterOptions reading;
    reading.heights = heights;
    const auto raster = terrella::RemoteTiff::make(*file, *std::move(pyramid), {}, reading);
    if (!raster && raster.error().message.empty()) std::abort();
    if (raster) read_some(**file, *parts, **raster);
  }
  return 0;
}
