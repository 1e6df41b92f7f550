#pragma once

#include <filesystem>

namespace terrella {

/// The name under which this process makes a merged cache before it gets the name `output`: hidden, in the same folder,
/// `.NAME.HOST.PID.part`. The host is in it because a folder may be shared by machines. thread: any
[[nodiscard]] std::filesystem::path merge_part_name(const std::filesystem::path& output);

/// Deletes what merges into `output` on this machine left when they were killed; those of processes that live, and of
/// other machines, stay. What cannot be deleted stays too. thread: any
void remove_dead_parts(const std::filesystem::path& output);

}  // namespace terrella
