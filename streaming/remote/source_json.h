#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/url.h"

namespace terrella {

inline constexpr std::size_t kMaxSourceJsonBytes = 1UL << 20;

/// Content of a JSON source description (fields in streaming/remote/README.md).
struct SourceDescription {
  enum class Kind { url_template, wmts, wms, tms };
  Kind kind = Kind::url_template;
  Url address;            ///< the template, or the address of the capabilities document or the tilemapresource.xml
  RemoteOptions options;  ///< all other fields
};

/// Reads a source description and checks each field. The error names `where` and the field. Unknown fields are refused.
/// thread: any
[[nodiscard]] Result<SourceDescription> parse_source_json(std::string_view text, const std::string& where);

}  // namespace terrella
