#include "apps/film/film_names.h"

#include <fmt/format.h>

#include <charconv>

#include "base/number.h"

namespace terrella {
namespace {

constexpr const char* kGood = "name the frames with one %d or %0Nd, as frames/%05d.png";

}  // namespace

bool is_movie_name(const std::string& output) { return output.ends_with(".mp4") || output.ends_with(".MP4"); }

Result<FrameNames> FrameNames::parse(const std::string& pattern) {
  const std::filesystem::path path(pattern);
  FrameNames names;
  names.folder_ = path.parent_path();
  names.pattern_ = path.filename().string();
  const std::string& text = names.pattern_;
  const std::size_t percent = text.find('%');
  if (names.folder_.string().find('%') != std::string::npos || percent == std::string::npos) {
    return Error{fmt::format("{} is no pattern of file names; {}, or a film.mp4", in_quotes(pattern), kGood)};
  }
  std::size_t d = percent + 1;
  if (d + 1 < text.size() && text[d] == '0' && text[d + 1] >= '1' && text[d + 1] <= '9') {
    names.digits_ = text[d + 1] - '0';
    d += 2;
  }
  if (d >= text.size() || text[d] != 'd' || text.find('%', d) != std::string::npos) {
    return Error{fmt::format("{}: {}", in_quotes(pattern), kGood)};
  }
  names.before_ = text.substr(0, percent);
  names.after_ = text.substr(d + 1);
  return names;
}

std::string FrameNames::name(std::int64_t frame) const {
  return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::filesystem::path FrameNames::folder() const { return folder_.empty() ? "." : folder_; }

std::filesystem::path FrameNames::path(std::int64_t frame) const { return folder_ / name(frame); }

std::optional<std::int64_t> FrameNames::frame_of(const std::string& file) const {
  if (file.size() <= before_.size() + after_.size()) return std::nullopt;
  std::int64_t frame = -1;
  const char* const begin = file.data() + before_.size();
  const auto read = std::from_chars(begin, file.data() + file.size() - after_.size(), frame);
  if (read.ec != std::errc() || frame < 0 || name(frame) != file) return std::nullopt;
  return frame;
}

}  // namespace terrella
