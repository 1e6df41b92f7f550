#pragma once

#include <string>

#include "streaming/url.h"

namespace terrella {

/// Reason why the terms of a host (2024) forbid bulk download of its tiles; empty if none is known. Sub-domains belong
/// to the host, look-alikes do not. thread: any
[[nodiscard]] std::string bulk_refusal(const Url& url);

}  // namespace terrella
