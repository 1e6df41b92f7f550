#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <ostream>
#include <random>
#include <vector>

#include "geo/body.h"
#include "geo/coordinates.h"

namespace terrella::test {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Random numbers with a fixed seed: every run draws the same.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  [[nodiscard]] double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(bits_);
  }
  template <class Integer>
  [[nodiscard]] Integer whole(Integer low, Integer high) {
    return std::uniform_int_distribution<Integer>(low, high)(bits_);
  }
  [[nodiscard]] EcefDir direction() {
    std::normal_distribution<double> normal;
    const double x = normal(bits_);
    const double y = normal(bits_);
    return EcefDir{glm::normalize(glm::dvec3(x, y, normal(bits_)))};
  }

 private:
  std::mt19937_64 bits_;
};

/// Bodies from the smallest to the flattest that the engine is for, and one flatter than any planet.
inline std::vector<Body> test_bodies() {
  std::vector<Body> bodies;
  for (const char* text : {"earth", "sphere", "mars", "phobos", "saturn", "6378137,0.098", "1e10,0", "1,0.3"}) {
    bodies.push_back(*parse_body(text));
  }
  return bodies;
}

/// Every bit of a vector, the sign of zeros included: what "the same vertex" means on a seam.
struct Bits {
  std::uint64_t x, y, z;
  bool operator==(const Bits&) const = default;
};
inline Bits bits_of(const glm::dvec3& v) {
  return {std::bit_cast<std::uint64_t>(v.x), std::bit_cast<std::uint64_t>(v.y), std::bit_cast<std::uint64_t>(v.z)};
}
inline std::ostream& operator<<(std::ostream& out, const Bits& bits) {
  return out << std::hexfloat << '(' << std::bit_cast<double>(bits.x) << ", " << std::bit_cast<double>(bits.y) << ", "
             << std::bit_cast<double>(bits.z) << ')';
}

}  // namespace terrella::test
