#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/bench/truth/ray_caster.h"

namespace terrella::truth {

/// A source picture with its fingerprint, which is worth working out once.
struct Source {
  Picture picture;
  std::uint64_t fingerprint = 0;
};
[[nodiscard]] Source make_source(Picture picture);

/// `cast`, remembered in files of a folder (about 27 MB each at 1024×1024); the file's name is a hash of all that the
/// picture depends on, and the full list of it stands in the file. An unreadable or foreign file is cast anew. An empty
/// folder name remembers nothing. thread: any; two processes may share a folder, since a file appears complete.
[[nodiscard]] TruthImage cast_cached(const Source& source, const RowRule& rows, const Spheroid& body,
                                     const TruthCamera& camera, const TruthOptions& options,
                                     const std::filesystem::path& folder);

/// The key in words: pixels, rows, body, camera, size, rays, and the version of the ray caster.
[[nodiscard]] std::string truth_key(const Source& source, const RowRule& rows, const Spheroid& body,
                                    const TruthCamera& camera, const TruthOptions& options);

}  // namespace terrella::truth
