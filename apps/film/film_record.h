#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "apps/film/film_names.h"
#include "base/result.h"
#include "codecs/image.h"

namespace terrella {

/// The facts that decide the pixels of a film, by name: options and the flight.
using FilmFacts = std::map<std::string, std::string>;

/// The folder of a film's frames. film.json beside the frames holds the facts of the film (hashes of options, which may
/// contain secrets), so that frames of another film are not kept. A frame appears whole or not at all. A frame that
/// lacks tiles has an empty file *.incomplete beside it, and is drawn again by the next run. Several programs may write
/// different frames of a film at once. thread: one at a time
class FilmFolder {
 public:
  /// Makes the folder if needed. Fails if frames of another film are there, or frames without a film.json; `force`
  /// removes them. The error names the facts that differ.
  [[nodiscard]] static Result<FilmFolder> open(FrameNames names, const FilmFacts& facts, bool force);

  /// True if an earlier run wrote the frame, with all tiles.
  [[nodiscard]] bool has(std::int64_t frame) const;
  /// Removes what a killed run left of the frame, if that run has ended.
  void remove_parts(std::int64_t frame);
  /// The error names the file.
  [[nodiscard]] Status write(std::int64_t frame, const Image& image, bool complete);
  [[nodiscard]] const FrameNames& names() const { return names_; }

 private:
  explicit FilmFolder(FrameNames names) : names_(std::move(names)) {}
  void list_parts();
  [[nodiscard]] Status claim(const FilmFacts& facts, bool force);

  FrameNames names_;
  std::multimap<std::int64_t, std::string> parts_;  ///< files of runs that were killed, by frame
};

}  // namespace terrella
