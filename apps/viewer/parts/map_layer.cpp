#include "apps/viewer/parts/map_layer.h"

#include <GLFW/glfw3.h>

#include <utility>

namespace terrella {
namespace {

constexpr double kSlowFrame_ms = 40.0;        // 25 frames a second
constexpr std::chrono::seconds kMostWait(1);  // for the first pictures, if their tiles come slowly

Result<std::unique_ptr<MapPainter>> load_painter(const Body& body, const std::filesystem::path& places) {
  auto data = load_map(body, places);
  if (!data) return data.error();
  return std::make_unique<MapPainter>(*std::move(data), body.ellipsoid);
}

}  // namespace

MapLayer::MapLayer(const ViewerContext& context, std::filesystem::path places)
    : Part(context), places_(std::move(places)), exists_(has_map(context.globe.options().body, places_)) {}

void MapLayer::toggle() {
  if (!exists_) return say("The map is of the Earth. Start with --places to see names of another body.");
  on_ = !on_;
}

bool MapLayer::should_load() const {
  if (!on_ || !exists_ || tried_ || !first_frame_) return false;
  return context_.globe.settled() || std::chrono::steady_clock::now() > *first_frame_ + kMostWait;
}

bool MapLayer::changed() const {
  if (loading_.valid()) return loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  return should_load() || (on_ && painter_ && moves_ && context_.navigator.at_rest());
}

void MapLayer::update(double last_frame_ms) {
  moves_ = !context_.navigator.at_rest();
  const Camera& camera = context_.navigator.camera();
  const bool turned = std::exchange(camera_, camera) != camera;  // a press of a button alone is no motion
  slow_ = moves_ && (slow_ || (turned && last_frame_ms > kSlowFrame_ms));
  if (should_load()) {
    tried_ = true;
    loading_ = std::async(std::launch::async, [body = context_.globe.options().body, places = places_] {
      Loaded loaded = load_painter(body, places);
      glfwPostEmptyEvent();
      return loaded;
    });
  }
  if (loading_.valid() && loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    Loaded loaded = loading_.get();
    if (loaded) {
      painter_ = *std::move(loaded);
    } else {
      context_.messages.report(loaded.error().message);
    }
  }
  if (!first_frame_) first_frame_ = std::chrono::steady_clock::now();
}

void MapLayer::draw_lines(const View& view) const {
  if (!on_ || !painter_) return;
  painter_->draw_lines(context_.globe, view, context_.window.pixels_per_unit().x, detail());
}

std::vector<UiBox> MapLayer::draw_names(const View& view, const std::vector<UiBox>& taken) const {
  if (!on_ || !painter_ || slow_) return {};
  return painter_->draw_names(context_.globe, view, context_.window.pixels_per_unit().x, detail(), taken);
}

std::vector<std::string> MapLayer::attributions() const {
  return on_ && painter_ ? painter_->attributions() : std::vector<std::string>{};
}

}  // namespace terrella
