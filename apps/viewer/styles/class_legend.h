#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/viewer/panels/legend.h"
#include "streaming/objects/classes/class_style.h"

// thread: any, for all of this header
namespace terrella {

/// Writes the limits of classes with the least decimals, up to the tenth of the narrowest class, that tell them
/// apart: "0.25", "1200".
[[nodiscard]] std::vector<std::string> stop_texts(std::span<const double> stops);

/// The entry of a layer's classes in a legend: a colour and a range or a category for each class, then the rest.
[[nodiscard]] LegendItem class_legend(const std::string& layer, const ClassStyle& classes);

}  // namespace terrella
