#pragma once

namespace terrella {

/// True if the current context renders on the CPU (llvmpipe, softpipe, swrast, SWR, SwiftShader). thread: main
[[nodiscard]] bool is_software_gl();

}  // namespace terrella
