#pragma once

#include <filesystem>

namespace terrella {

/// A temporary name for a cache that is being made, before it gets the name `output`: hidden, in the same folder,
/// `.NAME.HOST.PID-N.part`, another one for each call. The name contains the host because several machines may share a
/// folder. thread: any
[[nodiscard]] std::filesystem::path cache_part_name(const std::filesystem::path& output);

/// Deletes parts of `output`, and their journals, that killed processes on this machine left behind. Parts of running
/// processes and of other machines stay. Parts that cannot be deleted stay too. thread: any
void remove_dead_parts(const std::filesystem::path& output);

}  // namespace terrella
