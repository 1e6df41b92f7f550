#include "streaming/cache/cache_place.h"

#include <sys/stat.h>

#include <system_error>
#include <utility>

#include "streaming/cache/cache_database.h"
#include "streaming/cache/cache_schema.h"
#include "streaming/cache/sqlite_writer.h"

namespace terrella {

CachePlace::CachePlace(std::filesystem::path path) : path_(std::move(path)), file_(look()) {}

std::optional<CachePlace::File> CachePlace::look() const {
  struct stat facts {};
  if (stat(path_.c_str(), &facts) != 0) return std::nullopt;
  return File{facts.st_dev, facts.st_ino, facts.st_size};
}

Status CachePlace::check() {
  if (found_) found_ = compare();
  return found_;
}

void CachePlace::note_size() {
  const std::optional<File> now = look();
  if (now && file_) file_->bytes = now->bytes;
}

/// Checks a file that has become shorter. Another process may have shortened it too, by eviction.
bool CachePlace::is_whole(const File& now) const {
  auto database = SqliteWriter::open(path_, SqliteWriter::Mode::read);
  if (!database) return database.error().problem == WriteProblem::busy;
  if (static_cast<std::uintmax_t>(now.bytes) <= kMaxQuickCheckBytes) {
    const auto sound = database->text("PRAGMA quick_check(1)");
    return sound ? *sound == "ok" : sound.error().problem == WriteProblem::busy;
  }
  const auto pages = database->integer("PRAGMA page_count");
  if (!pages) return pages.error().problem == WriteProblem::busy;
  std::error_code failed;
  const auto log = std::filesystem::file_size(path_.string() + "-wal", failed);
  return *pages * kCachePageBytes <= now.bytes + (failed ? 0 : static_cast<std::int64_t>(log));
}

Status CachePlace::compare() {
  const std::optional<File> now = look();
  if (!now || !file_ || now->device != file_->device || now->number != file_->number) {
    return Error{path_.string() +
                 ": another program removed, renamed or replaced the cache while it was in use; what was stored is not "
                 "under that name; start again"};
  }
  const bool shorter = now->bytes < std::exchange(file_, now)->bytes;
  if (!shorter || is_whole(*now)) return Done{};
  return Error{path_.string() +
               ": another program shortened or damaged the cache while it was in use; what was stored may be lost; a "
               "new run sets the file aside"};
}

}  // namespace terrella
