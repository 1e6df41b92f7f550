#pragma once

namespace terrella {

/// How many of `wanted` connections the limit on open files leaves room for, at least 1, beside what a program has open
/// anyway (about sixteen: cache and log of each reader, notifications, standard streams). Raises the process's limit
/// first, as far as the system lets it. thread: main
[[nodiscard]] int connections_that_fit(int wanted);

}  // namespace terrella
