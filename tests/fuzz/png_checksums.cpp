// A changed PNG whose checksums are right again, so that what is behind them is reached. libFuzzer calls this by its
// name.
#include <arpa/inet.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

/// PNG 1.2, 3.2: the length, four letters, the bytes, and the checksum of letters and bytes.
void mend_checksums(std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kSignature = 8, kAround = 12;
  for (std::size_t at = kSignature; at + kAround <= size;) {
    std::uint32_t length = 0;
    std::memcpy(&length, data + at, sizeof(length));
    length = ntohl(length);
    if (length > size - at - kAround) return;
    const std::uint32_t sum = htonl(static_cast<std::uint32_t>(crc32(0, data + at + 4, length + 4)));
    std::memcpy(data + at + 8 + length, &sum, sizeof(sum));
    at += kAround + length;
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned) {
  size = LLVMFuzzerMutate(data, size, max_size);
  if (size > 8 && std::memcmp(data, "\x89PNG", 4) == 0) mend_checksums(data, size);
  return size;
}
