#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

inline constexpr std::size_t kMaxUrlBytes = 8192;

/// Checks `set.url`: the scheme is http, https or, if `files`, file; level, column and row all occur, nothing unknown
/// does, and the host depends only on {s}. The error begins with `where` and names the fault. thread: any
[[nodiscard]] Status check_url_template(const RemoteTileSet& set, bool files, const std::string& where);

/// Applies options common to all kinds of source: name, attribution, headers, lives, body, projection, bounds. Also
/// finds out if the host forbids bulk download. thread: any
void apply_options(RemoteTileSet& set, const RemoteOptions& options);

/// Makes the set of a URL template and the grid given by `options`. thread: any
[[nodiscard]] Result<RemoteTileSet> template_tile_set(const Url& url, const RemoteOptions& options, bool files,
                                                      const std::string& where);

}  // namespace terrella
