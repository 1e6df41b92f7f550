#include "globe/globe_impl.h"

// Image layers that follow the globe's time (ImageLook::clock).
namespace terrella {

std::optional<UtcTime> Globe::Impl::layer_clock() const {
  return experiments.layer_clock ? experiments.layer_clock : options.time;
}

void Globe::Impl::follow_clock() {
  std::vector<LayerId> ids;  // a layer may take another's place meanwhile
  ids.reserve(images.size());
  for (const auto& layer : images) ids.push_back(layer->id());
  for (const LayerId id : ids) follow_clock(id);
}

// Each instant is asked for once: one that is missing is not asked for again in every frame.
void Globe::Impl::follow_clock(LayerId id) {
  ImageLayer& shown = *image(id);
  const LayerClock clock = shown.look().clock;
  const std::shared_ptr<const TimeSteps> steps = shown.source()->info().steps;
  const std::optional<UtcTime> time = layer_clock();
  if (clock == LayerClock::own || !time || !steps || steps->empty()) {
    shown.set_early(false);
    if (following.erase(id) > 0) drop_coming(id, Coming::ahead);
    return;
  }
  Following& one = following[id];
  if (one.steps != steps) one = {.steps = steps};
  const std::optional<UtcTime> step = steps->at_or_before(*time);
  const auto follow = [&](const Status& followed, UtcTime instant) {
    if (!followed) missing_instants.push_back({id, instant, followed.error().message});
  };
  if (step && one.step != step) {
    one.step = step;
    follow(go_to_time(shown, *step), *step);
    put_in_place();
  }
  image(id)->set_early(!step);
  const bool is_there = newest_coming(*image(id)) == nullptr;  // the next one is asked for after it
  const std::optional<UtcTime> next =
      step && is_there && clock == LayerClock::globe_fades ? steps->after(*step) : std::optional<UtcTime>();
  if (next == one.next) return;
  one.next = next;
  one.fades = false;
  next ? follow(load_ahead(*image(id), *next), *next) : drop_coming(id, Coming::ahead);
}

Globe::Impl::Fade Globe::Impl::fade_of(const ImageLayer& shown) const {
  const auto found = following.find(shown.id());
  const std::optional<UtcTime> time = layer_clock();
  const bool mixes = shown.look().blend == LayerBlend::normal;  // the sum of two other blends is no mean
  if (found == following.end() || !found->second.fades || !time || !mixes) return {};
  const Following& one = found->second;
  ImageLayer* next = coming_at(shown, *one.next);
  if (next == nullptr || !next->turn().is_ahead || newest_coming(shown) != nullptr) return {};
  const double share = std::chrono::duration<double>(*time - *one.step) / (*one.next - *one.step);
  return share > 0.0 && share < 1.0 ? Fade{next, share} : Fade{};
}

// Two layers of opacity a(1-s)/(1-as) and as, one over the other, have the mean of their colours with weights 1-s and s
// at opacity a.
ImageLayer* Globe::Impl::fade_over(ImageLayer& shown) {
  shown.set_share(1.0);
  if (const auto found = following.find(shown.id()); found != following.end() && found->second.next) {
    const ImageLayer* next = coming_at(shown, *found->second.next);
    found->second.fades = next != nullptr && (found->second.fades || (next->is_ready() && !next->is_void()));
  }
  const auto [next, share] = fade_of(shown);
  if (next == nullptr) return nullptr;
  if (next->look() != shown.look()) next->set_look(shown.look());
  next->set_share(share);
  shown.set_share((1.0 - share) / (1.0 - shown.look().opacity * share));
  return next;
}

}  // namespace terrella
