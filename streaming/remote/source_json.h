#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/url.h"

namespace terrella {

inline constexpr std::size_t kMaxSourceJsonBytes = 1UL << 20;

/// What a JSON source description says (fields in streaming/remote/README.md).
struct SourceDescription {
  enum class Kind { url_template, wmts, tms };
  Kind kind = Kind::url_template;
  Url address;            ///< the template, or where the capabilities document or the tilemapresource.xml is
  RemoteOptions options;  ///< all its other fields
};

/// Reads a source description and checks every field by itself. The error names `where` and the field; fields that are
/// not known are refused. thread: any
[[nodiscard]] Result<SourceDescription> parse_source_json(std::string_view text, const std::string& where);

}  // namespace terrella
