#include "apps/viewer/parts/pictures.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/tools/screenshot.h"

namespace terrella {
namespace {

constexpr float kPictureWidth = 22.0F, kPictureHeight = 9.0F;  // in text heights

std::filesystem::path next_file() {
  std::error_code unknown;
  return new_file_name(std::filesystem::current_path(unknown), std::chrono::system_clock::now());
}

}  // namespace

void Pictures::draw_open(float foot) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float half = std::min(0.5F * kPictureWidth * unit, 0.5F * size.x - 0.8F * unit);
  UiBox room = Ui::panel_room(0.5F * size.x - half, 0.5F * size.x + half, foot);
  const auto last = Ui::panel_box(panel());
  const double height = last ? last->bottom - last->top : double(kPictureHeight * unit);
  room.top = std::max(room.top, std::min(0.5 * (double(size.y) - height), room.bottom - height));
  place_panel(room);
  ImGui::SetNextWindowBgAlpha(0.9F);
  const bool just_opened = take_just_opened();
  if (just_opened) ImGui::SetNextWindowFocus();
  begin_panel(panel());
  ImGui::PushItemWidth(0.55F * kPictureWidth * unit);
  if (just_opened) ImGui::SetKeyboardFocusHere();
  draw_fields(largest_picture_side_px());
  bool save = ImGui::Button("Save");
  tip("Enter: loads all tiles of the picture, then saves a PNG in the folder where the program was started.");
  ImGui::SameLine();
  bool leave = ImGui::Button("Close");
  leave = entered() || leave;
  save = (entered_panel() && !leave) || save;
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextDisabled("F12 saves the window with its panels.");
  ImGui::PopTextWrapPos();
  ImGui::PopItemWidth();
  ImGui::End();
  if (save || leave) toggle();
  if (save) start();
}

void Pictures::draw_fields(int most_px) {
  if (width_px_ <= 0) {
    const Viewport window = context_.window.framebuffer();
    width_px_ = 2 * window.width_px;
    height_px_ = 2 * window.height_px;
  }
  ImGui::InputInt("Width", &width_px_, 64, 1024);
  tip("In pixels. The picture shows the window's view from top to bottom; a wide picture shows more at the sides.");
  ImGui::InputInt("Height", &height_px_, 64, 1024);
  tip("In pixels.");
  width_px_ = std::clamp(width_px_, 1, most_px);
  height_px_ = std::clamp(height_px_, 1, most_px);
  ImGui::Checkbox("Map, graticule, legend", &with_map_);
  tip("Draws those that the window shows now.");
  ImGui::Checkbox("Sources", &with_credits_);
  tip("Names the sources of imagery and map in the upper right corner.");
}

PictureOverlay Pictures::wanted_overlay() const {
  PictureOverlay all = overlay_();
  if (!with_map_) all = {.credits = std::move(all.credits)};
  if (!with_credits_) all.credits.clear();
  return all;
}

void Pictures::start() {
  auto job = PictureJob::start(context_.globe, next_file(), {width_px_, height_px_});
  if (!job) return say(job.error());
  job_ = *std::move(job);
}

void Pictures::end(const std::string& message) {
  job_.reset();
  say(message);
}

bool Pictures::cancel() {
  if (!job_ || job_->drawn()) return false;
  end("Picture cancelled");
  return true;
}

void Pictures::draw_picture(Viewport framebuffer) {
  job_->draw(context_.globe, framebuffer, [this] { return wanted_overlay(); });
  const auto result = job_->result();
  if (result) end(*result ? "Saved " + job_->file().filename().string() : result->error().message);
}

void Pictures::after_frame(Viewport framebuffer) {
  if (!std::exchange(screenshot_wanted_, false)) return;
  const auto file = next_file();
  const Status saved = save_back_buffer(file, framebuffer);
  saved ? say("Saved " + file.filename().string()) : say(saved.error());
}

}  // namespace terrella
