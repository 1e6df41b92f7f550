#include "streaming/remote_tiff/remote_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <limits>
#include <utility>

namespace terrella {
namespace {

/// A block holds the directories of most files, and the places of thousands of tiles.
constexpr std::uint64_t kDirectoryBlockBytes = 32768;
/// For servers that state no expiry.
constexpr std::int64_t kVersionLife_s = 7LL * 24 * 3600;

std::uint64_t size_of_version(const FileVersion& version) {
  // A server need not state the length. Reads beyond the end then end early.
  return version.file_bytes.value_or(std::numeric_limits<std::int64_t>::max());
}

/// A version found in the cache, or nothing.
struct HeldVersion {
  std::shared_ptr<RangeCache> ranges;
  FileVersion version;
};

Result<std::shared_ptr<RangeCache>> open_ranges(const RemoteFileOptions& options, const std::string& key) {
  if (!options.open_cache) return std::shared_ptr<RangeCache>();
  auto cache = options.open_cache(key);
  if (!cache) return cache.error();
  return *cache ? std::make_shared<RangeCache>(*std::move(cache)) : std::shared_ptr<RangeCache>();
}

Result<std::optional<HeldVersion>> find_held(const RemoteFileOptions& options) {
  const auto version = version_in_key(options.held_key, options.url);
  if (!version) return std::optional<HeldVersion>();
  auto ranges = open_ranges(options, options.held_key);
  if (!ranges) return ranges.error();
  if (!*ranges) return std::optional<HeldVersion>();
  return std::optional(HeldVersion{*std::move(ranges), *version});
}

/// Asks the server for the version. Returns the cache of that version.
Result<std::shared_ptr<RangeCache>> ask_version(const RemoteFileOptions& options, std::optional<HeldVersion> held,
                                                RangeReader& reader) {
  if (const auto first = reader.read({.offset = 0, .length = 1}); !first) return first.error();
  const HttpReply answer = reader.latest_answer();
  const std::string key = range_cache_key(options.url, reader.version());
  std::shared_ptr<RangeCache> ranges;
  if (held && key == options.held_key) {
    ranges = std::move(held->ranges);
  } else {
    held.reset();  // closes the file
    auto opened = answer.no_store ? Result<std::shared_ptr<RangeCache>>(std::shared_ptr<RangeCache>())
                                  : open_ranges(options, key);
    if (!opened) return opened.error();
    ranges = *std::move(opened);
  }
  const auto now_s = static_cast<std::int64_t>(std::time(nullptr));
  if (ranges) ranges->set_checked(now_s, answer.expires_unix_s.value_or(now_s + kVersionLife_s));
  reader.use_store(ranges, reader.version(), false);
  return ranges;
}

}  // namespace

/// Both views of a file. They belong to it and never outlive it in use.
class RemoteFile::Held : public ByteFile {
 public:
  explicit Held(const RemoteFile& file) : file_(file) {}
  [[nodiscard]] const std::string& name() const override { return file_.name_; }
  [[nodiscard]] std::uint64_t size() const override { return size_of_version(file_.address_.version); }
  [[nodiscard]] std::size_t read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    if (file_.read_lent(offset, into)) return into.size();
    if (into.size() > RangeReader::kMaxReadBytes || offset > size()) return 0;
    const auto bytes = file_.reader_->held({.offset = offset, .length = into.size()});
    if (!bytes) return 0;
    std::ranges::copy(*bytes, into.begin());
    return bytes->size();
  }

 private:
  const RemoteFile& file_;
};

class RemoteFile::Fetching : public ByteFile {
 public:
  explicit Fetching(const RemoteFile& file) : file_(file) {}
  [[nodiscard]] const std::string& name() const override { return file_.name_; }
  [[nodiscard]] std::uint64_t size() const override { return size_of_version(file_.address_.version); }
  [[nodiscard]] std::size_t read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    std::size_t done = 0;
    while (done < into.size() && offset + done < size()) {
      const auto length = std::min<std::uint64_t>(into.size() - done, RangeReader::kMaxReadBytes);
      const auto bytes = file_.reader_->read({.offset = offset + done, .length = length});
      if (!bytes) {
        const std::lock_guard lock(file_.mutex_);
        file_.fault_ = bytes.error().message;
      }
      if (!bytes || bytes->empty()) break;
      std::ranges::copy(*bytes, into.begin() + static_cast<std::ptrdiff_t>(done));
      done += bytes->size();
    }
    return done;
  }

 private:
  const RemoteFile& file_;
};

RemoteFile::RemoteFile(const RemoteFileOptions& options, std::unique_ptr<RangeReader> reader, Flag stopped,
                       std::shared_ptr<RangeCache> cache)
    : name_(options.url.redacted()),
      http_(options.http),
      offline_(options.offline),
      stopped_(std::move(stopped)),
      reader_(std::move(reader)),
      cache_(std::move(cache)),
      address_{.url = options.url, .headers = options.headers, .version = reader_->version()},
      held_(std::make_shared<Held>(*this)),
      fetching_(std::make_shared<Fetching>(*this)) {}

Result<std::shared_ptr<RemoteFile>> RemoteFile::open(const RemoteFileOptions& options) {
  auto held = find_held(options);
  if (!held) return held.error();
  const auto stopped = std::make_shared<std::atomic<bool>>(false);
  const auto go_on = [stopped, asked = options.go_on] { return !*stopped && asked(); };
  auto reader = std::make_unique<RangeReader>(options.url, options.headers, options.http, go_on, kDirectoryBlockBytes);
  if (*held && (options.offline || (*held)->ranges->is_checked(std::time(nullptr)))) {
    reader->use_store((*held)->ranges, (*held)->version, options.offline);
    return std::shared_ptr<RemoteFile>(new RemoteFile(options, std::move(reader), stopped, (*held)->ranges));
  }
  if (options.offline) {
    return Error{fmt::format("{}: nothing of it is in the cache; look at it or preload it once without ‹offline›",
                             options.url.redacted())};
  }
  auto ranges = ask_version(options, *std::move(held), *reader);
  if (!ranges) return ranges.error();
  return std::shared_ptr<RemoteFile>(new RemoteFile(options, std::move(reader), stopped, *std::move(ranges)));
}

std::string RemoteFile::take_fault() {
  const std::lock_guard lock(mutex_);
  return std::exchange(fault_, {});
}

bool RemoteFile::doubt_directories() {
  if (offline_ || doubted_.exchange(true)) return false;
  reader_->doubt_blocks();
  return true;
}

void RemoteFile::doubt_version() {
  const auto now_s = static_cast<std::int64_t>(std::time(nullptr));
  if (cache_) cache_->set_checked(now_s, now_s - 1);
}

bool RemoteFile::read_lent(std::uint64_t offset, std::span<std::byte> into) const {
  const std::lock_guard lock(mutex_);
  for (const auto& pieces : lent_) {
    for (const FilePiece& piece : pieces) {
      if (offset < piece.offset || !is_within({offset - piece.offset, into.size()}, piece.bytes->size())) continue;
      std::memcpy(into.data(), piece.bytes->data() + (offset - piece.offset), into.size());
      return true;
    }
  }
  return false;
}

RemoteFile::Loan::Loan(RemoteFile& file, std::vector<FilePiece> pieces) : file_(file) {
  const std::lock_guard lock(file.mutex_);
  place_ = file.lent_.insert(file.lent_.end(), std::move(pieces));
}

RemoteFile::Loan::~Loan() {
  const std::lock_guard lock(file_.mutex_);
  file_.lent_.erase(place_);
}

}  // namespace terrella
