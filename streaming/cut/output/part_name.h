#pragma once

#include <filesystem>
#include <functional>

#include "base/result.h"

namespace terrella {

/// Temporary name beside `output` for incomplete data: hidden, and used by no other process or call. thread: any
[[nodiscard]] std::filesystem::path part_name(const std::filesystem::path& output);

/// Waits until the file or directory is on the disk. thread: any
[[nodiscard]] Status sync_to_disk(const std::filesystem::path& path);

/// Decides if an existing output may be replaced. `there` is the output's name, or the place to which it was just
/// moved. The error says why it must stay.
using MayReplace = std::function<Status(const std::filesystem::path& there)>;

/// Gives `part` the name `output` in one step, durably.
/// `may_replace` is asked about an existing file or folder of that name. It is asked again after the old output was
/// moved aside, when nobody can exchange it any more. An output that must stay gets its name back. The replaced output
/// is then at `part`, and the caller removes it. thread: any
[[nodiscard]] Status take_name(const std::filesystem::path& part, const std::filesystem::path& output,
                               const MayReplace& may_replace);

/// The directory that contains `output`. thread: any
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& output);

}  // namespace terrella
