#include "apps/viewer/tools/folded_text.h"

#include <utf8proc.h>

#include <cstdlib>

#include "base/number.h"

namespace terrella {

std::string folded(std::string_view text) {
  text = trimmed(text);
  utf8proc_uint8_t* bare = nullptr;
  constexpr auto kHow = static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_DECOMPOSE | UTF8PROC_COMPAT |
                                                       UTF8PROC_STRIPMARK | UTF8PROC_CASEFOLD);
  const auto length = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                                   static_cast<utf8proc_ssize_t>(text.size()), &bare, kHow);
  if (length < 0) return std::string(text);
  std::string result(reinterpret_cast<const char*>(bare), static_cast<std::size_t>(length));
  std::free(bare);
  return result;
}

}  // namespace terrella
