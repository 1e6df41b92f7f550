#pragma once

namespace terrella {

/// Whether the current context draws with the processor alone (llvmpipe, softpipe, swrast, SWR, SwiftShader). thread:
/// the context's
[[nodiscard]] bool is_software_gl();

}  // namespace terrella
