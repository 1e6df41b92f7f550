#include "streaming/cache/cache_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>
#include <utility>

#include "streaming/cache/cache_database.h"
#include "streaming/sets/directory_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPatience{60'000};
/// If the log cannot be written back for this long, a reader is asleep; the log then grows.
constexpr std::chrono::seconds kLogPatience{10};
constexpr int kEvictedAtATime = 32;
/// Moving a page to the front of the file writes it. A step is small compared with a batch.
constexpr std::int64_t kPagesGivenBackAtATime = 128;

std::uint64_t log_bytes(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path.string() + "-wal", error);
  return error ? 0 : size;
}

WriteResult<std::int64_t> first_number(SqliteStatement& statement) {
  const WriteResult<bool> row = statement.step();
  const std::int64_t value = row && *row ? statement.integer(0) : 0;
  statement.reset();
  if (!row) return row.error();
  return value;
}

}  // namespace

WriteResult<std::unique_ptr<CacheWriter>> CacheWriter::make(SqliteWriter database, fs::path path, int root_level,
                                                            std::uint64_t max_bytes) {
  std::unique_ptr<CacheWriter> writer(new CacheWriter(std::move(database), std::move(path)));
  SqliteWriter& file = writer->database_;
  const WriteResult<std::int64_t> page_bytes = file.integer("PRAGMA page_size");
  if (!page_bytes) return page_bytes.error();
  writer->page_bytes_ = *page_bytes;
  writer->budget_ = cache_budget(max_bytes, *page_bytes);
  // A restarted log is truncated, so its size gives the amount of data in it.
  if (auto limited = file.integer("PRAGMA journal_size_limit = 0"); !limited) return limited.error();
  WriteResult<CacheRows> rows = CacheRows::prepare(file, root_level);
  if (!rows) return rows.error();
  writer->rows_ = *std::move(rows);
  const std::pair<std::optional<SqliteStatement>*, const char*> all[] = {
      {&writer->begin_, "BEGIN IMMEDIATE"},
      {&writer->commit_, "COMMIT"},
      {&writer->rollback_, "ROLLBACK"},
      {&writer->page_count_, "PRAGMA page_count"},
      {&writer->free_count_, "PRAGMA freelist_count"}};
  for (const auto& [slot, sql] : all) {
    WriteResult<SqliteStatement> statement = file.prepare(sql);
    if (!statement) return statement.error();
    *slot = *std::move(statement);
  }
  return writer;
}

Status CacheWriter::write(const CacheBatch& batch, std::vector<bool>& no_room) {
  database_.wait_for_locks(kPatience);
  evicted_now_ = pins_now_ = 0;
  WriteStatus done = begin_->run();
  database_.end_wait_for_lock();
  if (done) {
    done = write_rows(batch, std::time(nullptr), no_room);
    if (done) done = commit_->run();
    // SQLite has already rolled back after some errors. A second rollback does no harm.
    if (!done) static_cast<void>(rollback_->run());
  }
  const Status in_place = check_place();
  if (!in_place) return in_place;
  if (!done) return cache_error(path_, done.error());
  for (std::size_t i = 0; i < batch.changes.size(); ++i) stored_ += batch.changes[i].record && !no_room[i] ? 1 : 0;
  evicted_ += evicted_now_;
  pins_changed_ += pins_now_;
  keep_log_short();
  return Done{};
}

WriteStatus CacheWriter::write_rows(const CacheBatch& batch, std::int64_t now_unix_s, std::vector<bool>& no_room) {
  for (const auto& [row, used] : batch.uses) {
    if (WriteStatus noted = rows_->note_use(row, used); !noted) return noted;
  }
  std::uint64_t bytes = 0;
  for (const CacheChange& change : batch.changes) bytes += change.record ? change.record->bytes.size() : 0;
  const WriteResult<bool> room = make_room(pages_for(bytes, batch.changes.size(), page_bytes_));
  if (!room) return room.error();
  for (std::size_t i = 0; i < batch.changes.size(); ++i) {
    if (!*room) {
      const WriteResult<bool> this_one = fits(batch.changes[i]);
      if (!this_one) return this_one.error();
      no_room[i] = !*this_one;
      if (no_room[i]) continue;
    }
    if (WriteStatus done = write_row(batch.changes[i], now_unix_s); !done) return done;
  }
  return give_back_pages();
}

WriteStatus CacheWriter::write_row(const CacheChange& change, std::int64_t now_unix_s) {
  if (change.record) return rows_->put(change.id, *change.record, now_unix_s);
  if (!change.pin) return rows_->renew(change.id, change.renewal.stored_unix_s, change.renewal.expires_unix_s);
  const WriteResult<std::int64_t> changed = rows_->pin(change.id, *change.pin);
  if (!changed) return changed.error();
  pins_now_ += static_cast<std::uint64_t>(*changed);
  return Done{};
}

WriteResult<std::int64_t> CacheWriter::pages_too_many(std::int64_t needed_pages) {
  const WriteResult<std::int64_t> pages = first_number(*page_count_);
  if (!pages) return pages;
  const WriteResult<std::int64_t> free_pages = first_number(*free_count_);
  if (!free_pages) return free_pages;
  return pages_over(budget_, *pages, *free_pages, needed_pages);
}

WriteResult<bool> CacheWriter::make_room(std::int64_t needed_pages) {
  if (budget_.file_pages == 0) return true;
  while (true) {
    const WriteResult<std::int64_t> over = pages_too_many(needed_pages);
    if (!over) return over.error();
    if (*over == 0) return true;
    const WriteResult<std::int64_t> evicted = rows_->evict(kEvictedAtATime);
    if (!evicted) return evicted.error();
    if (*evicted == 0) return false;
    evicted_now_ += static_cast<std::uint64_t>(*evicted);
  }
}

WriteResult<bool> CacheWriter::fits(const CacheChange& change) {
  if (!change.record || change.record->missing) return true;
  const WriteResult<std::int64_t> there = rows_->tile_bytes(change.id);
  if (!there) return there.error();
  const auto bytes = static_cast<std::int64_t>(change.record->bytes.size());
  const auto more = static_cast<std::uint64_t>(std::max<std::int64_t>(0, bytes - *there));
  const WriteResult<std::int64_t> over = pages_too_many(pages_for(more, 1, page_bytes_));
  if (!over) return over.error();
  return *over == 0;
}

/// Shrinks the file by one step per batch. The file exceeds its limit only after the limit was lowered.
WriteStatus CacheWriter::give_back_pages() {
  if (budget_.file_pages == 0) return Done{};
  const WriteResult<std::int64_t> pages = first_number(*page_count_);
  if (!pages) return pages.error();
  if (*pages <= budget_.file_pages) return Done{};
  const std::int64_t step = std::min(*pages - budget_.file_pages, kPagesGivenBackAtATime);
  return database_.run(fmt::format("PRAGMA incremental_vacuum({})", step));
}

/// Writes the log back when it is long. A passive checkpoint waits for nobody, but cannot shorten the log while a
/// reader uses it. If the log gets much longer, wait for the readers, which are quick. Meanwhile nothing more is
/// written, even if another process writes the log back. Otherwise the log could grow to many times its share on a slow
/// disk.
void CacheWriter::keep_log_short() {
  const std::uint64_t log = log_bytes(path_);
  if (log < budget_.log_bytes) return;
  checkpoint("PASSIVE", std::chrono::milliseconds(0));
  if (log < budget_.log_bytes + budget_.log_bytes / 2) return;
  const auto give_up = std::chrono::steady_clock::now() + kLogPatience;
  while (!checkpoint("TRUNCATE", std::chrono::milliseconds(500)) && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

bool CacheWriter::checkpoint(const char* mode, std::chrono::milliseconds patience) {
  database_.wait_for_locks(patience);
  // The checkpoint may fail (another process does it, the disk is full). The next one succeeds and nothing is lost.
  const WriteResult<std::int64_t> busy = database_.integer(fmt::format("PRAGMA wal_checkpoint({})", mode));
  database_.wait_for_locks(kPatience);
  place_.note_size();
  return busy && *busy == 0;
}

void CacheWriter::tidy() {
  if (check_place() && log_bytes(path_) > 0) checkpoint("TRUNCATE", std::chrono::milliseconds(100));
}

void CacheWriter::close() {
  rows_.reset();
  for (auto* statement : {&begin_, &commit_, &rollback_, &page_count_, &free_count_}) statement->reset();
  if (!check_place()) {
    // SQLite deletes the log by its name, which may be the log of a file that took the name.
    database_.leave_log_on_close(true);
    return;
  }
  checkpoint("TRUNCATE", std::chrono::milliseconds(1000));
  database_.wait_for_locks(std::chrono::milliseconds(0));
  static_cast<void>(database_.run("PRAGMA journal_mode = DELETE"));
}

}  // namespace terrella
