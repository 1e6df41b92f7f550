#include "streaming/cut/output/record_log.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Marks the end record. Its x is the number of the other records.
constexpr std::int32_t kEndLevel = -1;
/// Room for an uncompressed tile of 4096 pixels, or a row of 2^20 pixels as floats.
constexpr std::uint32_t kMaxRecordBytes = 128U << 20;

struct Header {
  std::int32_t level;
  std::uint32_t size;
  std::int64_t x, y;
  std::int32_t squeeze;
  std::uint32_t checksum;  ///< CRC-32 of the preceding header fields and the bytes
};
static_assert(sizeof(Header) == 32);

std::uint32_t checksum_of(const Header& header, std::span<const std::byte> bytes) {
  const uLong begun = crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(&header), offsetof(Header, checksum));
  return static_cast<std::uint32_t>(crc32_z(begun, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

TileId id_of(const Header& header) {
  return {.level = header.level, .x = header.x, .y = header.y, .squeeze = header.squeeze};
}

fs::path part_of(const fs::path& path) { return path.string() + ".part"; }

/// Returns false at the end of the file, and at an incomplete record.
bool read_record(std::FILE* file, Header& header, std::vector<std::byte>& bytes) {
  if (std::fread(&header, sizeof(header), 1, file) != 1 || header.size > kMaxRecordBytes) return false;
  bytes.resize(header.size);
  if (std::fread(bytes.data(), 1, bytes.size(), file) != bytes.size()) return false;
  return checksum_of(header, bytes) == header.checksum;
}

}  // namespace

Result<std::unique_ptr<RecordLogWriter>> RecordLogWriter::open(fs::path path, bool resume, fs::path output, Told told) {
  std::unique_ptr<RecordLogWriter> log(new RecordLogWriter(std::move(path), std::move(output), std::move(told)));
  const fs::path part = part_of(log->path_);
  log->file_.reset(std::fopen(part.c_str(), resume ? "a+be" : "wbe"));
  if (!log->file_) return cannot_write(log->output_, errno);
  if (!resume) return log;
  std::FILE* file = log->file_.get();
  std::rewind(file);
  Header header{};
  std::vector<std::byte> bytes;
  long end = 0;
  while (read_record(file, header, bytes) && header.level != kEndLevel) {
    end = std::ftell(file);
    ++log->found_;
    if (log->told_) log->told_(id_of(header), static_cast<std::uint64_t>(end) - header.size, header.size);
  }
  std::fseek(file, end, SEEK_SET);
  if (ftruncate(fileno(file), end) != 0) return cannot_write(log->output_, errno);
  log->records_ = log->found_;
  log->end_ = static_cast<std::uint64_t>(end);
  return log;
}

Status RecordLogWriter::write(std::span<const std::byte> bytes) {
  if (bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size()) return Done{};
  return cannot_write(output_, errno);
}

Status RecordLogWriter::put(const TileId& id, std::span<const std::byte> bytes) {
  Header header{.level = id.level,
                .size = static_cast<std::uint32_t>(bytes.size()),
                .x = id.x,
                .y = id.y,
                .squeeze = id.squeeze,
                .checksum = 0};
  header.checksum = checksum_of(header, bytes);
  if (Status begun = write(std::as_bytes(std::span(&header, 1))); !begun) return begun;
  ++records_;
  if (Status written = write(bytes); !written) return written;
  end_ += sizeof(header) + bytes.size();
  if (!told_ || id.level == kEndLevel) return Done{};
  if (std::fflush(file_.get()) != 0) return cannot_write(output_, errno);
  told_(id, end_ - bytes.size(), bytes.size());
  return Done{};
}

Status RecordLogWriter::finish() {
  if (Status ended = put({.level = kEndLevel, .x = records_, .y = 0}, {}); !ended) return ended;
  if (std::fclose(file_.release()) != 0) return cannot_write(output_, errno);
  std::error_code failed;
  fs::rename(part_of(path_), path_, failed);
  if (failed) return cannot_write(output_, failed.value());
  return Done{};
}

Result<RecordLogReader> RecordLogReader::open(const fs::path& path) {
  LogFile file(std::fopen(path.c_str(), "rbe"));
  if (!file) return Error{fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno))};
  return RecordLogReader(path, std::move(file));
}

Result<std::optional<LogRecord>> RecordLogReader::next() {
  Header header{};
  LogRecord record;
  if (!read_record(file_.get(), header, record.bytes) || (header.level == kEndLevel && header.x != records_)) {
    return Error{fmt::format("{}: what an earlier run has left is damaged; remove it and cut again", path_.string())};
  }
  if (header.level == kEndLevel) return std::optional<LogRecord>{};
  ++records_;
  position_ += sizeof(header) + header.size;
  record.id = id_of(header);
  record.offset = position_ - header.size;
  return std::optional(std::move(record));
}

}  // namespace terrella
