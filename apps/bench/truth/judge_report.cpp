#include "apps/bench/truth/judge_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace terrella::truth {
namespace {

std::string limb_line(std::string_view name, const LimbError& limb) {
  return fmt::format("{:<26} {:>7.3f} % off by over {:.0f}: {} of {}\n", name, 100.0 * limb.share(), kLimbOff_levels,
                     limb.off, limb.pixels);
}

}  // namespace

std::string as_table(const Judgement& judgement) {
  std::string text = fmt::format("{:<26} {:>7} {:>7} {:>7} {:>9}\n", "zone", "RMS", "max", "bias", "pixels");
  for (std::size_t z = 0; z < kZones; ++z) {
    const ZoneError& zone = judgement.zones[z];
    if (zone.pixels == 0) continue;
    text += fmt::format("{:<26} {:>7.3f} {:>7.1f} {:>+7.3f} {:>9}\n", zone_name(static_cast<Zone>(z)), zone.rms,
                        zone.max, zone.bias, zone.pixels);
  }
  return text + limb_line("limb", judgement.limb) + limb_line("outside", judgement.outside);
}

nlohmann::json as_json(const Judgement& judgement) {
  nlohmann::json zones = nlohmann::json::object();
  for (std::size_t z = 0; z < kZones; ++z) {
    const ZoneError& zone = judgement.zones[z];
    zones[std::string(zone_name(static_cast<Zone>(z)))] = {
        {"rms", zone.rms}, {"max", zone.max}, {"bias", zone.bias}, {"pixels", zone.pixels}};
  }
  const auto limb = [](const LimbError& l) { return nlohmann::json{{"pixels", l.pixels}, {"off", l.off}}; };
  return {{"zones", zones}, {"limb", limb(judgement.limb)}, {"outside", limb(judgement.outside)}};
}

}  // namespace terrella::truth
