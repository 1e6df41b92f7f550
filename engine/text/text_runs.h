#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace terrella {

/// Characters of a line that are shaped together: one font, one script, one direction.
struct TextRun {
  std::size_t first = 0, count = 0;  ///< characters of the text
  std::uint32_t font = 0;
  std::uint32_t script = 0;  ///< tag of ISO 15924, as HarfBuzz's hb_script_t
  bool right_to_left = false;
};

/// Returns the runs of a line from left to right. The direction of the line is that of its first strong character; the
/// order is that of the Unicode bidirectional algorithm (UAX 9, by FriBidi). `fonts` has the font of each character.
/// thread: any
[[nodiscard]] std::vector<TextRun> text_runs(std::u32string_view text, std::span<const std::uint32_t> fonts);

}  // namespace terrella
