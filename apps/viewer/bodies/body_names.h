#pragma once

#include <string>

#include "geo/body.h"

// Names of bodies in the window. thread: any
namespace terrella {

/// Name with a capital: "Moon"; "Body of 1000 km" (the radius) if it is no preset.
[[nodiscard]] std::string body_title(const Body& body);
/// Name within a sentence: "the Moon", "Mars".
[[nodiscard]] std::string body_phrase(const Body& body);
/// Part of a file's name: "moon"; other characters than letters, digits and dots become "_".
[[nodiscard]] std::string body_file_word(const std::string& name);

}  // namespace terrella
