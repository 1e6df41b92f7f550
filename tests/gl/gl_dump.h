#pragma once

#include <map>
#include <string>
#include <vector>

namespace terrella::test {

/// Values of a context's state by name, indices after it.
using GlDump = std::map<std::string, std::vector<double>>;

/// All that a program may have set and would miss.
[[nodiscard]] GlDump dump_gl_state();
/// Values that differ, a line each.
[[nodiscard]] std::string differences(const GlDump& before, const GlDump& after);

}  // namespace terrella::test
