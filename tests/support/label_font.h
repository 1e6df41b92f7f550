#pragma once

#include <cstddef>
#include <fstream>
#include <iterator>
#include <vector>

namespace terrella::test {

/// Returns the bytes of the program's font of labels. The test's target defines TERRELLA_DATA_FOLDER.
inline std::vector<std::byte> label_font() {
  std::ifstream file(TERRELLA_DATA_FOLDER "/fonts/DejaVuSans.ttf", std::ios::binary);
  std::vector<std::byte> bytes;
  for (std::istreambuf_iterator<char> byte(file), end; byte != end; ++byte) {
    bytes.push_back(static_cast<std::byte>(*byte));
  }
  return bytes;
}

}  // namespace terrella::test
