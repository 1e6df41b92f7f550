#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define TERRELLA_FINDS_LEAKS 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TERRELLA_FINDS_LEAKS 1
#endif
#endif

#ifdef TERRELLA_FINDS_LEAKS
#include <sanitizer/lsan_interface.h>
#endif

namespace terrella::test {

/// True if memory is allocated that nothing points at, by LeakSanitizer, which then says where it came from; false
/// without it, or where it is off. To be asked while a driver that keeps memory of its own is still loaded: later it
/// would be told of memory that nobody can be asked about.
[[nodiscard]] inline bool has_leaked() {
#ifdef TERRELLA_FINDS_LEAKS
  return __lsan_do_recoverable_leak_check() != 0;
#else
  return false;
#endif
}

}  // namespace terrella::test
