#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

inline constexpr std::size_t kMaxUrlBytes = 8192;

/// Checks `set.url`: http, https or, if `files`, file; all of level, column and row stand in it, nothing unknown does,
/// and the host depends on nothing but {s}. The error begins with `where` and names what is wrong. thread: any
[[nodiscard]] Status check_url_template(const RemoteTileSet& set, bool files, const std::string& where);

/// Gives a set what `options` say of any kind of source: name, attribution, headers, lives, body, projection, bounds;
/// finds out whether its host forbids bulk download. thread: any
void apply_options(RemoteTileSet& set, const RemoteOptions& options);

/// The set of a URL template and of what `options` say of its grid. thread: any
[[nodiscard]] Result<RemoteTileSet> template_tile_set(const Url& url, const RemoteOptions& options, bool files,
                                                      const std::string& where);

}  // namespace terrella
