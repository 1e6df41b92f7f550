#include "streaming/http/range_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace terrella {
namespace {

constexpr std::uint64_t kBlockBytes = 16384;
constexpr std::size_t kMaxBlocks = (16UL << 20) / kBlockBytes;
constexpr std::chrono::milliseconds kBetweenLooks{100};

}  // namespace

bool FileVersion::differs_from(const HttpReply& reply) const {
  if (!etag.empty() && !reply.etag.empty()) return etag != reply.etag;
  if (!last_modified.empty() && !reply.last_modified.empty()) return last_modified != reply.last_modified;
  return file_bytes && reply.file_bytes && *file_bytes != *reply.file_bytes;
}

std::string FileVersion::strong_etag() const { return etag.starts_with("W/") ? std::string() : etag; }

RangeReader::RangeReader(Url url, std::vector<std::string> headers, const HttpOptions& options,
                         std::function<bool()> go_on)
    : url_(std::move(url)), headers_(std::move(headers)), go_on_(std::move(go_on)), fetcher_(options, replies_) {}

FileVersion RangeReader::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

Result<std::vector<std::byte>> RangeReader::read(const ByteRange& range) {
  assert(range.length <= kMaxReadBytes);
  std::vector<std::byte> bytes;
  if (range.length == 0) return bytes;
  const std::lock_guard lock(mutex_);
  const std::uint64_t first = range.offset / kBlockBytes, last = (range.offset + range.length - 1) / kBlockBytes;
  for (std::uint64_t begin = first; begin <= last; ++begin) {
    if (blocks_.contains(begin)) continue;
    std::uint64_t end = begin;
    while (end < last && !blocks_.contains(end + 1)) ++end;
    if (Status fetched = fetch_blocks(begin, end); !fetched) return fetched.error();
    begin = end;
  }
  for (std::uint64_t number = first; number <= last; ++number) {
    Block& block = blocks_.at(number);
    block.last_use = ++uses_;
    const std::uint64_t start = number * kBlockBytes;
    const std::uint64_t from = std::max(range.offset, start) - start;
    const std::uint64_t to = std::min<std::uint64_t>(range.offset + range.length - start, block.bytes.size());
    if (from >= to) break;
    bytes.insert(bytes.end(), block.bytes.begin() + static_cast<std::ptrdiff_t>(from),
                 block.bytes.begin() + static_cast<std::ptrdiff_t>(to));
  }
  drop_old();
  return bytes;
}

Status RangeReader::fetch_blocks(std::uint64_t first, std::uint64_t last) {
  const ByteRange range{.offset = first * kBlockBytes, .length = (last - first + 1) * kBlockBytes};
  const bool beyond = version_.file_bytes && range.offset >= *version_.file_bytes;
  std::vector<std::byte> body;
  if (!beyond) {
    Result<HttpReply> reply = ask(range);
    if (!reply) return reply.error();
    if (Status accepted = accept(*reply); !accepted) return accepted;
    body = std::move(reply->body);
  }
  for (std::uint64_t number = first; number <= last; ++number) {
    const auto from = std::min<std::size_t>((number - first) * kBlockBytes, body.size());
    const auto to = std::min<std::size_t>(from + kBlockBytes, body.size());
    const auto begin = body.begin() + static_cast<std::ptrdiff_t>(from);
    blocks_[number].bytes.assign(begin, body.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return Done{};
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

Result<HttpReply> RangeReader::ask(const ByteRange& range) {
  HttpRequest request;
  request.url = url_;
  request.headers = headers_;
  request.range = range;
  request.if_match = version_.strong_etag();
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
  while (blocks_.size() > kMaxBlocks) {
    blocks_.erase(std::ranges::min_element(blocks_, {}, [](const auto& entry) { return entry.second.last_use; }));
  }
}

}  // namespace terrella
