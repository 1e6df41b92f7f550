#pragma once

#include <string>
#include <string_view>

namespace terrella {

/// Replaces each setting that a message of a library names as ‹field› (engine/README.md) by the program's option.
/// Fields that no option sets stay. thread: any
[[nodiscard]] std::string with_option_names(std::string_view message);

/// Message as a person may see it: with_option_names(), and addresses without secrets. thread: any
[[nodiscard]] std::string shown_message(std::string_view message);

}  // namespace terrella
