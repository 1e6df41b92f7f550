#include "streaming/raster/byte_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "streaming/file_bytes.h"

namespace terrella {
namespace {

class LocalFile : public ByteFile {
 public:
  LocalFile(std::string name, int descriptor, std::uint64_t size)
      : name_(std::move(name)), descriptor_(descriptor), size_(size) {}
  ~LocalFile() override { ::close(descriptor_); }
  LocalFile(const LocalFile&) = delete;
  LocalFile& operator=(const LocalFile&) = delete;

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::uint64_t size() const override { return size_; }

  [[nodiscard]] std::size_t read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    return offset < size_ ? terrella::read_at(descriptor_, offset, into) : 0;
  }

 private:
  std::string name_;
  int descriptor_;
  std::uint64_t size_;
};

}  // namespace

Result<std::shared_ptr<const ByteFile>> open_byte_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  // A pipe would block without O_NONBLOCK.
  const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0 && errno == ENOENT) return Error{fmt::format("{}: no such file", name)};
  if (descriptor < 0) return Error{fmt::format("{}: cannot be opened: {}", name, std::strerror(errno))};
  struct stat facts {};
  const bool regular = ::fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode);
  if (regular) {
    return std::shared_ptr<const ByteFile>(
        std::make_shared<LocalFile>(name, descriptor, static_cast<std::uint64_t>(facts.st_size)));
  }
  ::close(descriptor);
  return Error{fmt::format("{}: is a folder, a pipe, a device or a socket; save the picture as a file", name)};
}

}  // namespace terrella
