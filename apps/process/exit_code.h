#pragma once

namespace terrella {

/// Exit codes of every subcommand.
enum ExitCode : int { kDone = 0, kFailed = 1, kWrongUsage = 2, kDoneInPart = 3 };

}  // namespace terrella
