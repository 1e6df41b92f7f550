#pragma once

#include <string>

#include "streaming/url.h"

namespace terrella {

/// Why tiles of this address may not be downloaded in bulk, by the terms of its host (2024); empty if none is known.
/// Sub-domains belong to the host, look-alikes do not. thread: any
[[nodiscard]] std::string bulk_refusal(const Url& url);

}  // namespace terrella
