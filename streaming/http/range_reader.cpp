#include "streaming/http/range_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

namespace terrella {
namespace {

constexpr std::uint64_t kKeptBytes = 16UL << 20;
constexpr std::chrono::milliseconds kBetweenLooks{100};

bool has_blank_block(std::span<const std::byte> bytes, std::uint64_t block_bytes) {
  while (!bytes.empty()) {
    const auto block = bytes.first(std::min<std::size_t>(block_bytes, bytes.size()));
    if (std::ranges::all_of(block, [](std::byte byte) { return byte == std::byte{0}; })) return true;
    bytes = bytes.subspan(block.size());
  }
  return false;
}

}  // namespace

bool FileVersion::differs_from(const HttpReply& reply) const {
  if (!etag.empty() && !reply.etag.empty()) return etag != reply.etag;
  if (!last_modified.empty() && !reply.last_modified.empty()) return last_modified != reply.last_modified;
  return file_bytes && reply.file_bytes && *file_bytes != *reply.file_bytes;
}

std::string FileVersion::strong_etag() const { return etag.starts_with("W/") ? std::string() : etag; }

RangeReader::RangeReader(Url url, std::vector<std::string> headers, const HttpOptions& options,
                         std::function<bool()> go_on, std::uint64_t block_bytes)
    : url_(std::move(url)),
      headers_(std::move(headers)),
      go_on_(std::move(go_on)),
      block_bytes_(block_bytes),
      fetcher_(options, replies_) {}

FileVersion RangeReader::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

HttpReply RangeReader::latest_answer() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void RangeReader::use_store(std::shared_ptr<RangeStore> store, const FileVersion& version, bool offline) {
  const std::lock_guard lock(mutex_);
  store_ = std::move(store);
  version_ = version;
  has_version_ = true;
  offline_ = offline;
}

ByteRange RangeReader::range_of(std::uint64_t number) const {
  return {.offset = number * block_bytes_, .length = block_bytes_};
}

void RangeReader::keep_blocks() {
  const std::lock_guard lock(mutex_);
  for (auto& [number, block] : blocks_) {
    if (store_ && !block.kept && !block.doubted) store_->keep(range_of(number), block.bytes);
    block.kept = true;
  }
}

void RangeReader::doubt_blocks() {
  const std::lock_guard lock(mutex_);
  if (offline_) return;
  for (auto& [number, block] : blocks_) {
    if (store_ && block.kept) store_->doubt(range_of(number));
    block.doubted = true;
  }
}

Result<std::vector<std::byte>> RangeReader::read(const ByteRange& range) {
  if (range.length > kMaxReadBytes) {
    return Error{
        fmt::format("{}: a range of {} bytes; ask for at most {}", url_.redacted(), range.length, kMaxReadBytes)};
  }
  if (range.length == 0) return std::vector<std::byte>();
  const std::uint64_t first = range.offset / block_bytes_, last = (range.offset + range.length - 1) / block_bytes_;
  Lock lock(mutex_);
  bool known = true;
  for (std::uint64_t number = first; number <= last; ++number) known = known && !needs_request(number);
  if (known) return put_together(range);
  lock.unlock();
  const std::lock_guard one(network_);
  lock.lock();
  for (std::uint64_t begin = first; begin <= last; ++begin) {
    if (!needs_request(begin)) continue;
    std::uint64_t end = begin;
    while (end < last && needs_request(end + 1)) ++end;
    if (Status fetched = fetch_blocks(lock, begin, end); !fetched) return fetched.error();
    begin = end;
  }
  std::vector<std::byte> bytes = put_together(range);
  drop_old();
  return bytes;
}

std::optional<std::vector<std::byte>> RangeReader::held(const ByteRange& range) {
  if (range.length == 0) return std::vector<std::byte>();
  const std::lock_guard lock(mutex_);
  const std::uint64_t first = range.offset / block_bytes_, last = (range.offset + range.length - 1) / block_bytes_;
  for (std::uint64_t number = first; number <= last; ++number) {
    if (!find_block(number)) return std::nullopt;
  }
  return put_together(range);
}

/// True if the block is in memory, maybe from the store.
bool RangeReader::find_block(std::uint64_t number) {
  if (blocks_.contains(number)) return true;
  if (!store_) return false;
  auto stored = store_->find(range_of(number));
  if (!stored) return false;
  blocks_[number] = {.bytes = *std::move(stored), .last_use = ++uses_, .kept = true};
  return true;
}

bool RangeReader::needs_request(std::uint64_t number) { return !find_block(number) || blocks_.at(number).doubted; }

std::vector<std::byte> RangeReader::put_together(const ByteRange& range) {
  std::vector<std::byte> bytes;
  for (std::uint64_t number = range.offset / block_bytes_; number * block_bytes_ < range.offset + range.length;
       ++number) {
    Block& block = blocks_.at(number);
    block.last_use = ++uses_;
    const std::uint64_t start = number * block_bytes_;
    const std::uint64_t from = std::max(range.offset, start) - start;
    const std::uint64_t to = std::min<std::uint64_t>(range.offset + range.length - start, block.bytes.size());
    if (from >= to) break;
    bytes.insert(bytes.end(), block.bytes.begin() + static_cast<std::ptrdiff_t>(from),
                 block.bytes.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return bytes;
}

Status RangeReader::fetch_blocks(Lock& lock, std::uint64_t first, std::uint64_t last) {
  const ByteRange range{.offset = first * block_bytes_, .length = (last - first + 1) * block_bytes_};
  const bool beyond = version_.file_bytes && range.offset >= *version_.file_bytes;
  auto body = beyond ? Result<std::vector<std::byte>>(std::vector<std::byte>()) : request(lock, range);
  if (body && has_blank_block(*body, block_bytes_)) body = request(lock, range);
  if (!body) return body.error();
  for (std::uint64_t number = first; number <= last; ++number) {
    const auto from = std::min<std::size_t>((number - first) * block_bytes_, body->size());
    const auto to = std::min<std::size_t>(from + block_bytes_, body->size());
    blocks_[number] = {
        .bytes = {body->begin() + static_cast<std::ptrdiff_t>(from), body->begin() + static_cast<std::ptrdiff_t>(to)},
        .last_use = uses_,
        .kept = beyond};
  }
  return Done{};
}

/// Gives up the lock while it waits.
Result<std::vector<std::byte>> RangeReader::request(Lock& lock, const ByteRange& range) {
  if (offline_) {
    return Error{fmt::format("{}: its bytes from {} on are not in the cache; open it once without ‹offline›",
                             url_.redacted(), range.offset)};
  }
  const FileVersion version = version_;
  lock.unlock();
  Result<HttpReply> reply = ask(range, version);
  lock.lock();
  if (!reply) return reply.error();
  if (Status accepted = accept(*reply); !accepted) return accepted.error();
  latest_ = *std::move(reply);
  return std::exchange(latest_.body, {});
}

Status RangeReader::accept(const HttpReply& reply) {
  if (has_version_ && version_.differs_from(reply)) {
    return Error{
        fmt::format("{}: the file has changed on the server since it was opened; open it again", url_.redacted())};
  }
  if (!has_version_) {
    version_ = {.etag = reply.etag, .last_modified = reply.last_modified, .file_bytes = reply.file_bytes};
  }
  has_version_ = true;
  return Done{};
}

Result<HttpReply> RangeReader::ask(const ByteRange& range, const FileVersion& version) {
  HttpRequest request;
  request.url = url_;
  request.headers = headers_;
  request.range = range;
  request.if_match = version.strong_etag();
  fetcher_.submit(std::move(request));
  std::vector<HttpReply> replies;
  while (replies.empty()) {
    if (!go_on_()) {
      fetcher_.cancel(0);
      return Error{url_.redacted() + ": stopped before the server answered"};
    }
    replies = replies_.take_all(kBetweenLooks);
  }
  if (replies.front().outcome != HttpOutcome::content) return Error{replies.front().why};
  return std::move(replies.front());
}

void RangeReader::drop_old() {
  while (blocks_.size() > kKeptBytes / block_bytes_) {
    blocks_.erase(std::ranges::min_element(blocks_, {}, [](const auto& entry) { return entry.second.last_use; }));
  }
}

}  // namespace terrella
