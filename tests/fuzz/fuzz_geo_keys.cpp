#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "streaming/georeference/crs.h"
#include "streaming/georeference/geo_keys.h"

namespace {

/// The next `count` values of the bytes, fewer if they end.
template <class T>
std::vector<T> take(const std::uint8_t*& data, std::size_t& size, std::size_t count) {
  std::vector<T> values(std::min(count, size / sizeof(T)));
  if (!values.empty()) std::memcpy(values.data(), data, values.size() * sizeof(T));
  data += values.size() * sizeof(T);
  size -= values.size() * sizeof(T);
  return values;
}

}  // namespace

// GeoKeys: the number of shorts in the directory, the directory, the number of doubles, the doubles, the text. A system
// that the keys name is opened, and a place asked for.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace terrella;
  GeoTags tags;
  const auto shorts = take<std::uint16_t>(data, size, 1);
  tags.key_directory = take<std::uint16_t>(data, size, shorts.empty() ? 0 : shorts[0]);
  const auto doubles = take<std::uint8_t>(data, size, 1);
  tags.key_numbers = take<double>(data, size, doubles.empty() ? 0 : doubles[0]);
  tags.key_text.assign(reinterpret_cast<const char*>(data), size);
  const auto keys = read_geo_keys(tags);
  if (!keys && keys.error().message.empty()) std::abort();
  if (!keys || keys->crs.empty()) return 0;
  const auto crs = Crs::open(keys->crs);
  if (!crs) return 0;
  if (!(crs->facts().a_m > 0.0) || !std::isfinite(crs->facts().b_m)) std::abort();
  (void)crs->places({{10.0, 20.0}, {500000.0, 4650000.0}});
  return 0;
}
