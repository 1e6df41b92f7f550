#include "text/font_search.h"

#include <fontconfig/fontconfig.h>

namespace terrella {

FontSearch::FontSearch() {
  const std::shared_ptr<FcPattern> wanted(FcPatternCreate(), &FcPatternDestroy);
  FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
  FcPatternAddBool(wanted.get(), FC_OUTLINE, FcTrue);
  FcPatternAddBool(wanted.get(), FC_COLOR, FcFalse);
  if (FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern) == FcFalse) return;
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultNoMatch;
  fonts_ = {FcFontSort(nullptr, wanted.get(), FcFalse, nullptr, &result), [](FcFontSet* fonts) {
              if (fonts != nullptr) FcFontSetDestroy(fonts);
            }};
}

std::optional<FontFace> FontSearch::find(char32_t character) const {
  for (int k = 0; fonts_ && k < fonts_->nfont; ++k) {
    FcPattern* const font = fonts_->fonts[k];
    FcCharSet* characters = nullptr;
    FcBool outline = FcFalse, color = FcFalse;
    FcChar8* path = nullptr;
    int index = 0;
    if (FcPatternGetCharSet(font, FC_CHARSET, 0, &characters) != FcResultMatch ||
        FcCharSetHasChar(characters, character) == FcFalse ||
        FcPatternGetBool(font, FC_OUTLINE, 0, &outline) != FcResultMatch || outline == FcFalse ||
        (FcPatternGetBool(font, FC_COLOR, 0, &color) == FcResultMatch && color != FcFalse) ||
        FcPatternGetString(font, FC_FILE, 0, &path) != FcResultMatch) {
      continue;
    }
    FcPatternGetInteger(font, FC_INDEX, 0, &index);
    return FontFace{reinterpret_cast<const char*>(path), index};
  }
  return std::nullopt;
}

}  // namespace terrella
