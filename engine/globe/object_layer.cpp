#include "globe/object_layer.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "tiles/late_workers.h"

namespace terrella {

ObjectLayer::Cutting::Cutting(CutJob job, const std::shared_ptr<ArrivalBell>& bell) : size_(job.size()) {
  auto work = [job = std::make_shared<CutJob>(std::move(job)), shared = shared_, bell] {
    try {
      shared->cut = cut_objects(std::move(*job), shared->stop);
    } catch (...) {
      shared->fault = std::current_exception();
    }
    shared->done = true;
    bell->ring();
  };
  try {
    worker_ = std::async(std::launch::async, work);
  } catch (const std::system_error&) {
    work();  // The system has no thread left.
  }
}

ObjectLayer::Cutting::~Cutting() {
  if (!worker_.valid()) return;
  shared_->stop = true;
  end_late(std::move(worker_));
}

CutObjects ObjectLayer::Cutting::take() {
  if (shared_->fault) std::rethrow_exception(shared_->fault);
  return std::move(shared_->cut);
}

std::size_t ObjectLayer::cut(Version& version) {
  CutJob job = version.objects.take_job();
  if (job.empty()) return 0;
  if (job.is_large()) {
    version.cutting.emplace_back(std::move(job), bell_);
    return 0;
  }
  const std::size_t size = job.size();
  version.objects.place(cut_objects(std::move(job), false));
  return size;
}

std::size_t ObjectLayer::set(ObjectScene scene, const Ellipsoid& ellipsoid, std::shared_ptr<const Relief> relief) {
  next_ =
      std::make_unique<Version>(LayerObjects(std::move(scene), Ground(ellipsoid, relief), opacity_, selected_color_));
  next_->heights_seen = relief ? relief->changes_seen() : 0;
  next_->relief = std::move(relief);
  const std::size_t size = cut(*next_);
  if (next_->cutting.empty()) {
    now_ = std::exchange(next_, nullptr);
    replaced_ = true;
  }
  return size;
}

// While a worker cuts, nothing follows: its cut would replace one of newer heights.
std::size_t ObjectLayer::follow(Version& version, const Ellipsoid& ellipsoid,
                                const std::shared_ptr<const Relief>& relief) {
  const bool stands = version.objects.stands_on_ground(), other = version.relief != relief;
  const std::uint64_t seen = relief ? relief->changes_seen() : 0;
  if (!other && (!stands || seen == version.heights_seen)) return 0;
  if (!version.cutting.empty()) return 0;
  version.objects.follow(Ground(ellipsoid, relief), [&](const Geodetic& place) {
    return other || relief->changed_since(place, version.heights_seen);
  });
  version.relief = relief;
  version.heights_seen = seen;
  return cut(version);
}

std::size_t ObjectLayer::follow(const Ellipsoid& ellipsoid, const std::shared_ptr<const Relief>& relief) {
  std::size_t size = 0;
  for (Version* version : {now_.get(), next_.get()}) {
    if (version != nullptr) size += follow(*version, ellipsoid, relief);
  }
  return size;
}

std::size_t ObjectLayer::edit(ObjectEdits edits, UnknownObjects& unknown) {
  Version& version = next_ ? *next_ : *now_;
  LayerObjects& objects = version.objects;
  if (edits.selected_color) objects.set_selected_color(selected_color_ = *edits.selected_color);
  for (const ObjectId gone : edits.remove) {
    if (!objects.remove(gone)) unknown.ids.push_back(gone);
  }
  if (!edits.add.empty()) objects.add(std::move(edits.add));
  const auto each = [](const auto& some, auto make, std::vector<ObjectId>& not_made) {
    for (const auto& one : some) {
      if (!make(one)) not_made.push_back(one.id);
    }
  };
  each(
      edits.moves, [&](const ObjectMove& move) { return objects.move(move); }, unknown.ids);
  each(
      edits.growths, [&](const LineGrowth& growth) { return objects.grow(growth); }, unknown.without_line);
  each(
      edits.shapes, [&](const ObjectShape& shape) { return objects.reshape(shape); }, unknown.without_shape);
  each(
      edits.changes, [&](const ObjectChange& change) { return objects.change(change); }, unknown.ids);
  each(
      edits.texts, [&](const ObjectText& text) { return objects.set_text(text); }, unknown.ids);
  return cut(version);
}

void ObjectLayer::set_opacity(double opacity) {
  opacity_ = opacity;
  for (Version* version : {now_.get(), next_.get()}) {
    if (version != nullptr) version->objects.set_opacity(opacity);
  }
}

std::size_t ObjectLayer::take_cuts(Version& version) {
  std::size_t size = 0;
  for (auto at = version.cutting.begin(); at != version.cutting.end();) {
    if (!at->is_done()) {
      ++at;
      continue;
    }
    Cutting done = std::move(*at);
    at = version.cutting.erase(at);
    size += done.size();
    version.objects.place(done.take());
  }
  version.objects.ask_for_grown();
  return size + cut(version);
}

std::size_t ObjectLayer::take_cuts() {
  std::size_t size = now_ ? take_cuts(*now_) : 0;
  if (!next_) return size;
  size += take_cuts(*next_);
  if (next_->cutting.empty()) {
    now_ = std::exchange(next_, nullptr);
    replaced_ = true;
  }
  return size;
}

bool ObjectLayer::has_news() const {
  return std::ranges::any_of(std::array{now_.get(), next_.get()}, [](const Version* version) {
    return version != nullptr && std::ranges::any_of(version->cutting, &Cutting::is_done);
  });
}

bool ObjectLayer::waits() const {
  if (!shown || opacity_ <= 0.0) return false;
  return next_ || (now_ && !now_->cutting.empty());
}

}  // namespace terrella
