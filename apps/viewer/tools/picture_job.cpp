#include "apps/viewer/tools/picture_job.h"

#include <epoxy/gl.h>
// epoxy before GLFW, which otherwise includes its own gl.h
#include <GLFW/glfw3.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "apps/open_scene/options/scene_options.h"
#include "apps/process/write_file.h"
#include "codecs/image.h"

namespace terrella {
namespace {

Status write_picture(const std::filesystem::path& file, Image image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  const auto png = encode_png(image);
  return png ? write_file(file, *png) : Status(Error{file.string() + ": " + png.error().message});
}

void forget_gl_errors() {
  while (glGetError() != GL_NO_ERROR) {
  }
}

}  // namespace

int largest_picture_side_px() {
  GLint viewport[2] = {}, texture = 0;
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  return std::min({kMaxSide_px, viewport[0], viewport[1], texture});
}

Result<std::unique_ptr<PictureJob>> PictureJob::start(const Globe& globe, const std::filesystem::path& file,
                                                      Viewport size) {
  const std::string what = fmt::format("A picture of {} x {} pixels", size.width_px, size.height_px);
  if (long(size.width_px) * size.height_px > kMostPicturePixels) {
    return Error{fmt::format("{} is too large: at most {} million pixels in all; choose a smaller size", what,
                             kMostPicturePixels / 1000000)};
  }
  std::unique_ptr<PictureJob> job(new PictureJob(globe, file, size));
  forget_gl_errors();
  job->target_.emplace(size);
  if (glGetError() != GL_NO_ERROR) return Error{what + " does not fit into the graphics memory; choose a smaller size"};
  return job;
}

bool PictureJob::draw(Globe& globe, Viewport window, const std::function<PictureOverlay()>& overlay) {
  if (!drawn()) {
    stats_ = globe.render(target_->framebuffer(), size_);
    Status status = globe.status();
    if (status && globe.settled()) status = finish(overlay());
    if (!status) written_ = std::async(std::launch::deferred, [status] { return status; });
  }
  show(window);
  return drawn();
}

// Draws what is over the globe, and begins to write the picture.
Status PictureJob::finish(const PictureOverlay& overlay) {
  if (Status over = draw_over_picture(globe_, target_->framebuffer(), size_, overlay); !over) return over;
  Image image{.width_px = size_.width_px, .height_px = size_.height_px, .rgba = target_->read()};
  written_ = std::async(std::launch::async, [file = file_, image = std::move(image)]() mutable {
    Status status = write_picture(file, std::move(image));
    glfwPostEmptyEvent();
    return status;
  });
  return Done{};
}

// Shows the picture centred, as large as fits.
void PictureJob::show(Viewport window) const {
  const double scale = std::min(double(window.width_px) / size_.width_px, double(window.height_px) / size_.height_px);
  const int width = std::max(1, int(scale * size_.width_px)), height = std::max(1, int(scale * size_.height_px));
  const int left = (window.width_px - width) / 2, low = (window.height_px - height) / 2;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  glBlitNamedFramebuffer(target_->framebuffer(), 0, 0, 0, size_.width_px, size_.height_px, left, low, left + width,
                         low + height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

bool PictureJob::ready() const {
  if (!drawn()) return globe_.needs_frame();
  return written_.wait_for(std::chrono::seconds(0)) != std::future_status::timeout;
}

std::optional<Status> PictureJob::result() {
  if (!drawn() || !ready()) return {};
  return written_.get();
}

std::string PictureJob::text() const {
  const std::string what = fmt::format("Picture of {} x {}: ", size_.width_px, size_.height_px);
  if (drawn()) return what + "writing " + file_.filename().string();
  const int wanted = stats_.tiles_wanted;
  return what + fmt::format("{} of {} tiles; Esc cancels", wanted - stats_.tiles_pending, wanted);
}

}  // namespace terrella
