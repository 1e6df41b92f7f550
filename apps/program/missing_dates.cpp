#include "apps/program/missing_dates.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/process/console.h"

namespace terrella {
namespace {

/// " (reason)"; empty if none is known.
std::string reason_of(const Globe& globe, LayerId layer, UtcTime instant) {
  const auto& all = globe.missing_instants();
  const auto found = std::ranges::find_if(
      all, [&](const MissingInstant& one) { return one.layer == layer && one.instant == instant; });
  return found == all.end() || found->why.empty() ? std::string() : " (" + one_line(found->why) + ")";
}

}  // namespace

std::vector<std::string> missing_dates(const OpenedScene& scene, const std::optional<UtcTime>& time) {
  const Globe& globe = *scene.globe;
  std::vector<std::string> sentences;
  for (const SceneLayer& image : scene.images) {
    const auto look = globe.look(image.id);
    const auto date = globe.layer_time(image.id);
    const auto steps = image.tiles ? image.tiles->info().steps : nullptr;
    if (!look || !date || look->clock == LayerClock::own || !steps || !time) continue;
    const std::optional<UtcTime> wanted = steps->at_or_before(*time);
    if (!wanted || date->shown == wanted) continue;
    const std::string name = image.source.address.redacted(), text = steps->text(*wanted);
    if (date->coming) {
      sentences.push_back(
          fmt::format("{}: the tiles of {} have not come; a longer --timeout waits for them", name, text));
    } else {
      const std::string shown = date->shown ? steps->text(*date->shown) + " is shown" : "the layer is hidden";
      sentences.push_back(
          fmt::format("{}: no tile of {} in view{}; {}", name, text, reason_of(globe, image.id, *wanted), shown));
    }
  }
  return sentences;
}

}  // namespace terrella
