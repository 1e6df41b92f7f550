#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"

// thread: any, for all of this header
namespace terrella {

/// True for the name of a film in one file: *.mp4.
[[nodiscard]] bool is_movie_name(const std::string& output);

/// The names of a film's frames, from a pattern such as frames/%05d.png.
class FrameNames {
 public:
  /// Reads a pattern with one %d or %0Nd in the name of the file. The error quotes the text and names a good pattern.
  [[nodiscard]] static Result<FrameNames> parse(const std::string& pattern);

  [[nodiscard]] std::filesystem::path folder() const;
  [[nodiscard]] std::filesystem::path path(std::int64_t frame) const;
  /// The frame that a file of the folder is named for; none for another file.
  [[nodiscard]] std::optional<std::int64_t> frame_of(const std::string& file) const;
  [[nodiscard]] const std::string& pattern() const { return pattern_; }  ///< without the folder

 private:
  [[nodiscard]] std::string name(std::int64_t frame) const;

  std::filesystem::path folder_;
  std::string pattern_, before_, after_;
  int digits_ = 0;
};

}  // namespace terrella
