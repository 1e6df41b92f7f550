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

bool Globe::Impl::follows_clock(const ImageLayer& layer) const {
  const auto& steps = layer.source()->info().steps;
  return layer.look().clock != LayerClock::own && layer_clock() && steps && !steps->empty();
}

// Each instant is asked for once: one that is missing is not asked for again in every frame. While the wanted one
// comes, the layer shows what it showed. It does not begin with another one, and does not stay at one that is yet to
// be.
void Globe::Impl::follow_clock(LayerId id) {
  ImageLayer& shown = *image(id);
  if (!follows_clock(shown)) {
    shown.set_early(false);
    if (following.erase(id) > 0) drop_coming(id, Coming::ahead);
    return;
  }
  const std::shared_ptr<const TimeSteps> steps = shown.source()->info().steps;
  Following& one = following[id];
  if (one.steps != steps) one = {.steps = steps};
  const std::optional<UtcTime> step = steps->at_or_before(*layer_clock());
  const ImageLayer* newest = newest_coming(shown);
  if (newest != nullptr && newest->source()->info().steps != steps) return;  // Globe::set_source() goes first
  if (step && one.step != step) {
    one.step = step;
    if (const Status asked = go_to_time(shown, *step); !asked) note_missing(id, *step, asked.error().message);
    put_in_place();
  }
  ImageLayer& now = *image(id);
  const bool is_there = newest_coming(now) == nullptr;
  const std::optional<UtcTime> instant = now.source()->info().instant;
  const bool is_new = now.views().empty();  // nothing of it has been on the screen
  now.set_early(!step || (is_there ? instant && *instant > *step : is_new));
  follow_next(now, step && is_there ? steps->after(*step) : std::nullopt);
}

// The next instant is asked for once the present one is there.
void Globe::Impl::follow_next(const ImageLayer& shown, std::optional<UtcTime> next) {
  Following& one = following[shown.id()];
  if (shown.look().clock != LayerClock::globe_fades) next.reset();
  const bool is_known = next == one.next && (!next || one.has_failed || coming_at(shown, *next) != nullptr);
  if (is_known) return;
  one.next = next;
  one.fades = false;
  if (!next) return drop_coming(shown.id(), Coming::ahead);
  one.has_failed = !load_ahead(shown, *next);  // told when the instant itself is asked for
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
// at opacity a. Where one of them is transparent the other must fade alone: with a(1-s).
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
  const bool alone = shown.is_see_through() || next->is_see_through();
  shown.set_share((1.0 - share) / (alone ? 1.0 : 1.0 - shown.look().opacity * share));
  return next;
}

}  // namespace terrella
