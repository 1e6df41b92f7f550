#include "apps/viewer/bodies/body_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace terrella {

std::string body_title(const Body& body) {
  const bool named = std::ranges::find(body_presets(), body.name, &Body::name) != body_presets().end();
  if (!named) return fmt::format("Body of {:.6g} km", body.ellipsoid.a_m() / 1000.0);
  std::string title = body.name;
  title.front() = char(std::toupper(static_cast<unsigned char>(title.front())));
  return title;
}

std::string body_phrase(const Body& body) {
  constexpr std::array kWithArticle = {"earth", "moon", "sun"};
  const std::string title = body_title(body);
  if (std::ranges::find(kWithArticle, body.name) != kWithArticle.end()) return "the " + title;
  if (body.name == "sphere") return "a sphere";
  return title.find(' ') == title.npos ? title : "a b" + title.substr(1);
}

std::string body_file_word(const std::string& name) {
  std::string word = name;
  std::ranges::replace_if(
      word, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.'; }, '_');
  return word;
}

}  // namespace terrella
