#pragma once

#include <cstdint>
#include <string_view>

namespace terrella {

/// Mixes a number so that every input bit affects all output bits. The mapping is one to one: the finaliser of
/// SplitMix64 (Steele, Lea and Flood 2014, doi:10.1145/2660193.2660195). Ids of neighbouring tiles differ in few bits;
/// without mixing, a hash table puts them into the same buckets. thread: any
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t v) {
  v = (v ^ (v >> 30)) * 0xBF58476D1CE4E5B9U;
  v = (v ^ (v >> 27)) * 0x94D049BB133111EBU;
  return v ^ (v >> 31);
}

/// FNV-1a, 64 bits (Fowler, Noll, Vo). The value is the same on every machine. Good enough for file names that only
/// have to differ. thread: any
[[nodiscard]] constexpr std::uint64_t name_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace terrella
