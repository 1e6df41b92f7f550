#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "streaming/sets/open_tile_set.h"
#include "tiles/tile_range.h"
#include "tiles/tile_source.h"

namespace {

/// The input as a file in memory, which SQLite opens by the name that the system gives it.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0 || write(descriptor_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  const auto source = terrella::open_tile_set(file.path());
  if (!source) return 0;
  const terrella::TileGrid& grid = (*source)->info().grid;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    int reads = 0;
    terrella::for_each_place(grid, level, [&](const terrella::TileId& id) {
      static_cast<void>((*source)->read(id));
      return ++reads < 8;
    });
    static_cast<void>((*source)->count_tiles(level));
  }
  return 0;
}
