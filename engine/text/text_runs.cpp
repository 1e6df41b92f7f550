#include "text/text_runs.h"

#include <fribidi.h>
#include <hb.h>

#include <algorithm>

namespace terrella {
namespace {

/// Returns the embedding level of each character; odd levels run from right to left.
std::vector<FriBidiLevel> levels_of(std::u32string_view text) {
  const std::vector<FriBidiChar> characters(text.begin(), text.end());
  const auto count = static_cast<FriBidiStrIndex>(text.size());
  std::vector<FriBidiCharType> types(text.size());
  std::vector<FriBidiBracketType> brackets(text.size());
  std::vector<FriBidiLevel> levels(text.size());
  fribidi_get_bidi_types(characters.data(), count, types.data());
  fribidi_get_bracket_types(characters.data(), count, types.data(), brackets.data());
  FriBidiParType direction = FRIBIDI_PAR_ON;
  if (fribidi_get_par_embedding_levels_ex(types.data(), brackets.data(), count, &direction, levels.data()) == 0) {
    std::ranges::fill(levels, FriBidiLevel{0});  // out of memory
  }
  return levels;
}

/// Returns the script of each character. One that belongs to several, as a space, has that of the character before it.
std::vector<hb_script_t> scripts_of(std::u32string_view text) {
  hb_unicode_funcs_t* const unicode = hb_unicode_funcs_get_default();
  std::vector<hb_script_t> scripts(text.size());
  hb_script_t last = HB_SCRIPT_COMMON;
  const auto is_shared = [](hb_script_t script) {
    return script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED || script == HB_SCRIPT_UNKNOWN;
  };
  for (std::size_t k = 0; k < text.size(); ++k) {
    const hb_script_t own = hb_unicode_script(unicode, text[k]);
    if (!is_shared(own)) last = own;
    scripts[k] = last;
  }
  const auto first = std::ranges::find_if_not(scripts, is_shared);
  if (first != scripts.end()) std::fill(scripts.begin(), first, *first);
  return scripts;
}

}  // namespace

std::vector<TextRun> text_runs(std::u32string_view text, std::span<const std::uint32_t> fonts) {
  const std::vector<FriBidiLevel> levels = levels_of(text);
  const std::vector<hb_script_t> scripts = scripts_of(text);
  std::vector<TextRun> runs;
  std::vector<int> run_levels;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool same = k > 0 && levels[k] == levels[k - 1] && scripts[k] == scripts[k - 1] && fonts[k] == fonts[k - 1];
    if (same) {
      ++runs.back().count;
      continue;
    }
    runs.push_back({k, 1, fonts[k], static_cast<std::uint32_t>(scripts[k]), levels[k] % 2 == 1});
    run_levels.push_back(levels[k]);
  }
  // Rule L2 of UAX 9: from the highest level to the lowest odd one, what has at least that level is reversed.
  const int highest = run_levels.empty() ? 0 : *std::ranges::max_element(run_levels);
  for (int level = highest; level > 0; --level) {
    for (std::size_t from = 0; from < runs.size(); ++from) {
      std::size_t to = from;
      while (to < runs.size() && run_levels[to] >= level) ++to;
      const auto at = [](auto& values, std::size_t k) { return values.begin() + static_cast<std::ptrdiff_t>(k); };
      std::reverse(at(runs, from), at(runs, to));
      std::reverse(at(run_levels, from), at(run_levels, to));
      from = std::max(from, to);
    }
  }
  return runs;
}

}  // namespace terrella
