#include "apps/viewer/action.h"

#include <algorithm>

namespace terrella {

bool in_menu(const Action& action) {
  return action.keys != nullptr && action.run != nullptr && (action.flags & (Action::repeats | Action::unlisted)) == 0;
}

std::string menu_text(const Action& action) {
  std::string text(action.what);
  text.erase(std::min(text.find(':'), text.size()));
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = char(text[0] - 'a' + 'A');
  return text;
}

const char* mouse_way(const Action& action) {
  if (action.mouse != nullptr) return action.mouse;
  return in_menu(action) ? "menu" : "";
}

}  // namespace terrella
