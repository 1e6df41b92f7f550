#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>

#include "streaming/cut/output/part_name.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Returns 0 or errno.
int write_file(const fs::path& path, std::span<const std::byte> bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  int failed = 0;
  while (!bytes.empty() && failed == 0) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      failed = written == 0 ? ENOSPC : errno;
    }
  }
  if (close(file) != 0 && failed == 0) failed = errno;
  return failed;
}

class FolderWriter : public TileWriter {
 public:
  explicit FolderWriter(const WriterSetup& setup)
      : output_(setup.output),
        part_(setup.part.string() + ".new"),
        info_(setup.info),
        mark_(setup.mark),
        may_replace_(setup.may_replace) {}
  ~FolderWriter() override {
    std::error_code ignored;
    fs::remove_all(part_, ignored);
  }
  FolderWriter(const FolderWriter&) = delete;
  FolderWriter& operator=(const FolderWriter&) = delete;

  [[nodiscard]] Status open() {
    std::error_code failed;
    fs::remove_all(part_, failed);
    fs::create_directory(part_, failed);
    if (failed) return cannot_write(output_, failed.value());
    return Done{};
  }

  [[nodiscard]] Status put(const TileId& id, std::span<const std::byte> bytes) override {
    const fs::path levels = id.squeeze == 0 ? part_ : part_ / kSqueezedFolder;
    const fs::path folder = levels / std::to_string(id.level) / std::to_string(id.x);
    const fs::path file = folder / fmt::format("{}.{}", id.y, tile_ending(info_));
    int failed = write_file(file, bytes);
    if (failed == ENOENT) {
      std::error_code ignored;
      fs::create_directories(folder, ignored);
      failed = write_file(file, bytes);
    }
    if (failed != 0) return cannot_write(output_, failed);
    return Done{};
  }

  [[nodiscard]] Status finish() override {
    const std::string description = to_tileset_json(info_, mark_);
    if (const int failed = write_file(part_ / kTileSetFile, std::as_bytes(std::span(description))); failed != 0) {
      return cannot_write(output_, failed);
    }
    // Syncs all files with one call; syncing a million files one by one takes hours.
    if (const int folder = ::open(part_.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECTORY); folder >= 0) {
      const int failed = syncfs(folder) == 0 ? 0 : errno;
      close(folder);
      if (failed != 0) return cannot_write(output_, failed);
    }
    return take_name(part_, output_, may_replace_);
  }

 private:
  fs::path output_;
  fs::path part_;
  TileSetInfo info_;
  std::string mark_;
  MayReplace may_replace_;
};

}  // namespace

Result<std::unique_ptr<TileWriter>> make_folder_writer(const WriterSetup& setup) {
  auto writer = std::make_unique<FolderWriter>(setup);
  if (Status opened = writer->open(); !opened) return opened.error();
  return std::unique_ptr<TileWriter>(std::move(writer));
}

}  // namespace terrella
