#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "streaming/cut/input/row_reader.h"

namespace {

/// The readers take files; this one is only in memory.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("rows", 0)) {
    while (size > 0) {
      const ssize_t written = write(file_, data, size);
      if (written <= 0) break;
      data += written;
      size -= static_cast<std::size_t>(written);
    }
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace

/// Whatever the bytes are, the readers of pictures give rows or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A header can claim rows by the million that cost nothing to make: enough is read to pass every stage.
  constexpr std::int64_t kMostRows = 256;
  const MemoryFile file(data, size);
  auto reader = terrella::open_rows(file.path());
  if (!reader) return 0;
  const auto& info = (*reader)->info();
  std::vector<std::uint8_t> row(static_cast<std::size_t>(info.width_px) * 4);
  for (std::int64_t y = 0; y < std::min(info.height_px, kMostRows); ++y) {
    if (!(*reader)->read_row(row)) break;
  }
  return 0;
}
