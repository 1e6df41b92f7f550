#include "streaming/cut/input/height_samples.h"

namespace terrella {

void to_numbers(const HeightCoding& coding, std::span<float> heights) {
  if (coding.kind == HeightKind::uint16) return;
  for (float& height : heights) {
    height = coding.kind == HeightKind::int16
                 ? height + 32768.0F
                 : static_cast<float>((static_cast<double>(height) - coding.offset) / coding.scale);
  }
}

}  // namespace terrella
