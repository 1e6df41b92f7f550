#include "streaming/tiff_open.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>

namespace terrella {
namespace {

/// Most memory that libtiff may allocate for one strip, tile or table with sizes from the file.
constexpr tmsize_t kMaxSingleAllocation = 256L << 20;

struct FreeOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

int keep_error(TIFF*, void* text, const char*, const char* format, std::va_list arguments) {
  char line[256];
  std::vsnprintf(line, sizeof(line), format, arguments);
  *static_cast<std::string*>(text) = line;
  return 1;
}
/// Ignores warnings, such as unknown tags, that do not affect pixels.
int pass_over(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }

}  // namespace

TiffHandle open_tiff(const std::string& name, std::string& message) {
  const std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
  if (!options) return {};
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &message);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), pass_over, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxSingleAllocation);
  // m: no memory map, because its size would count as memory held.
  return TiffHandle(TIFFOpenExt(name.c_str(), "rm", options.get()));
}

bool begins_as_tiff(std::string_view head) {
  using namespace std::string_view_literals;
  constexpr std::array kHeads = {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv};
  return std::ranges::any_of(kHeads, [head](std::string_view start) { return head.starts_with(start); });
}

}  // namespace terrella
