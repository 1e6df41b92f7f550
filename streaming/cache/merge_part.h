#pragma once

#include <filesystem>

namespace terrella {

/// Temporary name of a merged cache, before it is renamed to `output`: hidden, in the same folder,
/// `.NAME.HOST.PID.part`. The name contains the host because several machines may share a folder. thread: any
[[nodiscard]] std::filesystem::path merge_part_name(const std::filesystem::path& output);

/// Deletes parts of `output` that killed merges on this machine left behind. Parts of running processes and of other
/// machines stay. Parts that cannot be deleted stay too. thread: any
void remove_dead_parts(const std::filesystem::path& output);

}  // namespace terrella
