#pragma once

#include <memory>
#include <optional>
#include <string>

struct _FcFontSet;

namespace terrella {

/// A face in a font file.
struct FontFace {
  std::string path;
  int index = 0;  ///< number of the face in a collection
  [[nodiscard]] bool operator==(const FontFace&) const = default;
};

/// The fonts of the system that have outlines, as Fontconfig sorts them for sans-serif text in the user's language.
/// Making one reads Fontconfig's cache: 10 to 100 ms. thread: any, but one call at a time
class FontSearch {
 public:
  FontSearch();
  /// Returns the first font that has a character; nothing if none has it.
  [[nodiscard]] std::optional<FontFace> find(char32_t character) const;

 private:
  std::shared_ptr<_FcFontSet> fonts_;  ///< null if Fontconfig has no configuration
};

}  // namespace terrella
