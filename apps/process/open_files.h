#pragma once

namespace terrella {

/// Number of connections, 1 to `wanted`, that the limit on open files allows. About sixteen files stay reserved for the
/// cache and log of each reader, notifications and standard streams. Raises the process's limit first, as far as the
/// system allows. thread: main
[[nodiscard]] int connections_that_fit(int wanted);

}  // namespace terrella
