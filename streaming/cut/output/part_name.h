#pragma once

#include <filesystem>
#include <functional>

#include "base/result.h"

namespace terrella {

/// A name beside `output` for what is not whole yet: hidden, and no other process or call uses it. thread: any
[[nodiscard]] std::filesystem::path part_name(const std::filesystem::path& output);

/// Waits until the file or directory is on the disk. thread: any
[[nodiscard]] Status sync_to_disk(const std::filesystem::path& path);

/// Looks at what stands under an output's name, or did until now and lies at `there`: done, or why it must stay.
using MayReplace = std::function<Status(const std::filesystem::path& there)>;

/// Gives `part` the name `output` in one step, and makes that last. A file or folder that has the name is asked about
/// first, and again when it is out of the way and nobody can exchange it any more: one that must stay gets its name
/// back. What was replaced lies at `part` then; the caller removes it. thread: any
[[nodiscard]] Status take_name(const std::filesystem::path& part, const std::filesystem::path& output,
                               const MayReplace& may_replace);

/// The directory that `output` is in. thread: any
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& output);

}  // namespace terrella
