#include "streaming/raster/gdal/gdal_memory_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "streaming/raster/gdal/gdal_library.h"

namespace terrella {
namespace {

constexpr const char* kPrefix = "/vsiterrella/";

/// Files that are mounted, by their name after kPrefix, by which GDAL asks for them.
class Mounts {
 public:
  std::string add(std::shared_ptr<const ByteFile> bytes) {
    const std::lock_guard lock(mutex_);
    std::string name = std::to_string(++last_);
    files_.emplace(name, std::move(bytes));
    return name;
  }
  void remove(const std::string& name) {
    const std::lock_guard lock(mutex_);
    files_.erase(name);
  }
  std::shared_ptr<const ByteFile> find(const char* name) const {
    const std::lock_guard lock(mutex_);
    const auto file = files_.find(name);
    return file == files_.end() ? nullptr : file->second;
  }

 private:
  mutable std::mutex mutex_;
  std::uint64_t last_ = 0;
  std::map<std::string, std::shared_ptr<const ByteFile>> files_;
};

Mounts& mounts() {
  static Mounts all;
  return all;
}

/// A file that GDAL has open.
struct OpenFile {
  std::shared_ptr<const ByteFile> bytes;
  vsi_l_offset position = 0;
  bool at_end = false;
};

OpenFile& as_file(void* handle) { return *static_cast<OpenFile*>(handle); }

int stat_file(void*, const char* name, VSIStatBufL* found, int) {
  const auto file = mounts().find(name);
  if (!file) return -1;
  *found = {};
  found->st_mode = S_IFREG | 0444;
  found->st_size = static_cast<off_t>(std::min<std::uint64_t>(file->size(), std::numeric_limits<off_t>::max()));
  return 0;
}

void* open_file(void*, const char* name, const char* access) {
  const bool writes = std::string_view(access).find_first_of("wa+") != std::string_view::npos;
  auto file = writes ? nullptr : mounts().find(name);
  return file ? new OpenFile{std::move(file)} : nullptr;
}

vsi_l_offset tell(void* handle) { return as_file(handle).position; }

int seek(void* handle, vsi_l_offset offset, int whence) {
  OpenFile& file = as_file(handle);
  const vsi_l_offset from = whence == SEEK_END ? file.bytes->size() : whence == SEEK_CUR ? file.position : 0;
  file.position = from + offset;
  file.at_end = false;
  return 0;
}

std::size_t read(void* handle, void* into, std::size_t size, std::size_t count) {
  OpenFile& file = as_file(handle);
  if (size == 0 || count == 0) return 0;
  const std::size_t got = file.bytes->read_at(file.position, {static_cast<std::byte*>(into), size * count});
  file.position += got;
  file.at_end = got < size * count;
  return got / size;
}

int is_at_end(void* handle) { return as_file(handle).at_end ? 1 : 0; }

int close_file(void* handle) {
  delete static_cast<OpenFile*>(handle);
  return 0;
}

/// GDAL keeps a handler for ever.
bool install() {
  VSIFilesystemPluginCallbacksStruct* calls = gdal().VSIAllocFilesystemPluginCallbacksStruct();
  calls->stat = stat_file;
  calls->open = open_file;
  calls->tell = tell;
  calls->seek = seek;
  calls->read = read;
  calls->eof = is_at_end;
  calls->close = close_file;
  const bool installed = gdal().VSIInstallPluginHandler(kPrefix, calls) == 0;
  gdal().VSIFreeFilesystemPluginCallbacksStruct(calls);
  return installed;
}

}  // namespace

GdalMount::GdalMount(std::shared_ptr<const ByteFile> bytes) {
  [[maybe_unused]] static const bool is_installed = install();
  name_ = mounts().add(std::move(bytes));
  path_ = kPrefix + name_;
}
GdalMount::~GdalMount() { mounts().remove(name_); }

}  // namespace terrella
