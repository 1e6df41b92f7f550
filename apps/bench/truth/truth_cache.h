#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/bench/truth/ray_caster.h"

namespace terrella::truth {

/// A source picture with its fingerprint, computed once.
struct Source {
  Picture picture;
  std::uint64_t fingerprint = 0;
};
[[nodiscard]] Source make_source(Picture picture);

/// Calls `cast` and caches the result in files of a folder, about 27 MB each at 1024×1024. The file's name is a hash of
/// all inputs; the file contains their full list. An unreadable or foreign file is cast anew. An empty folder name
/// disables the cache. Two processes may share a folder, because files appear complete. thread: any
[[nodiscard]] TruthImage cast_cached(const Source& source, const RowRule& rows, const Spheroid& body,
                                     const TruthCamera& camera, const TruthOptions& options,
                                     const std::filesystem::path& folder);

/// The key in words: pixels, rows, body, camera, size, rays, and the version of the ray caster.
[[nodiscard]] std::string truth_key(const Source& source, const RowRule& rows, const Spheroid& body,
                                    const TruthCamera& camera, const TruthOptions& options);

}  // namespace terrella::truth
