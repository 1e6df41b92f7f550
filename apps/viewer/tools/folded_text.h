#pragma once

#include <string>
#include <string_view>

namespace terrella {

/// Returns a text as searches compare it: without case, accents and blanks around it. Text that is not UTF-8 is kept as
/// it is. thread: any
[[nodiscard]] std::string folded(std::string_view text);

}  // namespace terrella
