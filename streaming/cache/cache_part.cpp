#include "streaming/cache/cache_part.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartEnding = ".part";
constexpr std::string_view kJournalEnding = "-journal";  // SQLite's ending

fs::path part_folder(const fs::path& output) {
  return output.parent_path().empty() ? fs::path(".") : output.parent_path();
}

std::string part_prefix(const fs::path& output) {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host = {"localhost"};
  return fmt::format(".{}.{}.", output.filename().string(), host.data());
}

/// Process id in the name of a part or of its journal; nothing if the name is no part with that prefix.
std::optional<pid_t> part_owner(std::string_view name, std::string_view prefix) {
  if (name.ends_with(kJournalEnding)) name.remove_suffix(kJournalEnding.size());
  if (!name.starts_with(prefix) || !name.ends_with(kPartEnding)) return std::nullopt;
  if (name.size() <= prefix.size() + kPartEnding.size()) return std::nullopt;
  name.remove_prefix(prefix.size());
  name.remove_suffix(kPartEnding.size());
  pid_t process = 0;
  const char* const name_end = name.data() + name.size();
  auto [end, failed] = std::from_chars(name.data(), name_end, process);
  // Numbers of zero and below are process groups, not processes.
  if (failed != std::errc() || process <= 0) return std::nullopt;
  unsigned call = 0;
  if (end != name_end && *end == '-') end = std::from_chars(end + 1, name_end, call).ptr;
  return end == name_end ? std::optional(process) : std::nullopt;
}

/// Treats a process of another user (EPERM) as alive.
bool is_dead(pid_t process) { return kill(process, 0) != 0 && errno == ESRCH; }

}  // namespace

fs::path cache_part_name(const fs::path& output) {
  static std::atomic<unsigned> calls{0};
  return part_folder(output) / fmt::format("{}{}-{}{}", part_prefix(output), getpid(), calls++, kPartEnding);
}

void remove_dead_parts(const fs::path& output) {
  const std::string prefix = part_prefix(output);
  std::vector<fs::path> dead;
  std::error_code error;
  for (fs::directory_iterator entry(part_folder(output), error), end; !error && entry != end; entry.increment(error)) {
    const std::optional<pid_t> owner = part_owner(entry->path().filename().string(), prefix);
    if (owner && is_dead(*owner)) dead.push_back(entry->path());
  }
  for (const fs::path& part : dead) fs::remove(part, error);
}

}  // namespace terrella
