#pragma once

#include <cstddef>
#include <cstring>

namespace terrella {

/// All channels of a pixel, summed at once.
template <std::size_t kChannels>
struct Lanes;
template <>
struct Lanes<4> {
  using Vector = float __attribute__((vector_size(16)));
};
template <>
struct Lanes<2> {
  using Vector = float __attribute__((vector_size(8)));
};
template <std::size_t kChannels>
typename Lanes<kChannels>::Vector load(const float* from) {
  typename Lanes<kChannels>::Vector lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

}  // namespace terrella
