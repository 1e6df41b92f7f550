#include "render/gl/gl_driver.h"

#include <epoxy/gl.h>
#include <algorithm>
#include <array>
#include <string_view>

namespace terrella {

bool is_software_gl() {
  const auto* text = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (text == nullptr) return false;
  constexpr std::array<std::string_view, 5> kSoftware{"llvmpipe", "softpipe", "swrast", "SWR", "SwiftShader"};
  return std::ranges::any_of(kSoftware, [renderer = std::string_view(text)](std::string_view name) {
    return renderer.find(name) != std::string_view::npos;
  });
}

}  // namespace terrella
