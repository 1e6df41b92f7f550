#include "streaming/remote_tiff/range_cache.h"

#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "streaming/remote/remote_tile_set.h"

namespace terrella {
namespace {

using nlohmann::ordered_json;

/// Levels of the cache's tiles. The coarsest is never evicted: without directories no tile can be read.
constexpr int kBlocks = 0, kSpans = 1;
/// Place of the record of the latest check; no block is there.
constexpr TileId kChecked{.level = kBlocks, .x = -1, .y = 0};

TileId id_of(int level, std::uint64_t offset) {
  return {.level = level,
          .x = static_cast<std::int64_t>(offset >> 32),
          .y = static_cast<std::int64_t>(offset & 0xFFFFFFFFULL)};
}

CacheRecord record_of(std::vector<std::byte> bytes) {
  CacheRecord record;
  record.bytes = std::move(bytes);
  record.stored_unix_s = std::time(nullptr);
  return record;
}

std::string text_in(const ordered_json& key, const char* field) {
  const auto found = key.find(field);
  return found != key.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

TileSetInfo range_cache_info() {
  TileSetInfo info;
  info.name = "byte ranges";
  info.grid.min_level = kBlocks;
  info.grid.max_level = kSpans;
  info.format = ImageFormat::png;
  return info;
}

std::string range_cache_key(const Url& url, const FileVersion& version) {
  ordered_json key;
  key["ranges"] = without_secrets(url);
  key["etag"] = version.etag;
  key["last_modified"] = version.last_modified;
  if (version.file_bytes) key["bytes"] = *version.file_bytes;
  return key.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::optional<FileVersion> version_in_key(const std::string& key, const Url& url) {
  const auto read = ordered_json::parse(key, nullptr, false);
  if (!read.is_object() || text_in(read, "ranges") != without_secrets(url)) return std::nullopt;
  FileVersion version{
      .etag = text_in(read, "etag"), .last_modified = text_in(read, "last_modified"), .file_bytes = std::nullopt};
  if (const auto bytes = read.find("bytes"); bytes != read.end() && bytes->is_number_unsigned()) {
    version.file_bytes = bytes->get<std::uint64_t>();
  }
  return version;
}

std::optional<std::vector<std::byte>> RangeCache::bytes_of(const TileId& id) {
  auto found = cache_->find(id);
  if (!found || !*found || (*found)->missing || !is_fresh(**found, std::time(nullptr))) return std::nullopt;
  return std::move((*found)->bytes);
}

/// Only ranges in doubt have an expiry.
void RangeCache::expire(const TileId& id) {
  const auto now_s = static_cast<std::int64_t>(std::time(nullptr));
  cache_->renew(id, now_s, now_s);
}

void RangeCache::doubt(const ByteRange& block) { expire(id_of(kBlocks, block.offset)); }
void RangeCache::doubt_span(const ByteRange& span) { expire(span_id(span)); }

std::optional<std::vector<std::byte>> RangeCache::find(const ByteRange& block) {
  auto bytes = bytes_of(id_of(kBlocks, block.offset));
  if (bytes && bytes->size() > block.length) return std::nullopt;
  return bytes;
}

void RangeCache::keep(const ByteRange& block, std::vector<std::byte> bytes) {
  if (!bytes.empty()) cache_->store(id_of(kBlocks, block.offset), record_of(std::move(bytes)));
}

TileId RangeCache::span_id(const ByteRange& span) { return id_of(kSpans, span.offset); }

std::optional<std::vector<std::byte>> RangeCache::find_span(const ByteRange& span) {
  auto bytes = bytes_of(span_id(span));
  if (bytes && bytes->size() != span.length) return std::nullopt;
  return bytes;
}

void RangeCache::keep_span(const ByteRange& span, std::vector<std::byte> bytes) {
  cache_->store(span_id(span), record_of(std::move(bytes)));
}

bool RangeCache::is_checked(std::int64_t now_unix_s) {
  const auto record = cache_->peek(kChecked);
  return record && *record && is_fresh(**record, now_unix_s);
}

void RangeCache::set_checked(std::int64_t now_unix_s, std::int64_t until_unix_s) {
  CacheRecord record = record_of({std::byte{1}});
  record.stored_unix_s = now_unix_s;
  record.expires_unix_s = until_unix_s;
  cache_->store(kChecked, std::move(record));
}

}  // namespace terrella
