#pragma once

#include <future>

namespace terrella {

/// Keeps a worker that still reads for an owner that is gone. The end of the program waits for it. thread: any
void end_late(std::future<void> worker);

}  // namespace terrella
