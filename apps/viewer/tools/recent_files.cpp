#include "apps/viewer/tools/recent_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/process/user_folder.h"
#include "apps/viewer/tools/kept_json.h"
#include "streaming/url.h"

namespace terrella {
namespace {

constexpr const char* kRecentField = "recent";

}  // namespace

Result<RecentFiles> RecentFiles::load(const std::filesystem::path& file) {
  RecentFiles recent;
  const Result<nlohmann::json> json = read_kept_json(file);
  if (!json) return json.error();
  if (json->is_null()) return recent;
  const auto kept = json->find(kRecentField);
  if (kept == json->end() || !kept->is_array()) {
    return Error{file.string() + ": not a list of recent files; remove this file to begin a new list"};
  }
  for (auto one = kept->rbegin(); one != kept->rend(); ++one) {
    if (one->is_string()) recent.add(one->get<std::string>());
  }
  return recent;
}

Status RecentFiles::save(const std::filesystem::path& file) const {
  const nlohmann::json json = {{kRecentField, all_}};
  return write_kept_json(file, json);
}

void RecentFiles::add(const std::string& opened) {
  if (opened.empty() || Url(opened).redacted() != opened) return;
  std::erase(all_, opened);
  all_.insert(all_.begin(), opened);
  if (all_.size() > kMost) all_.resize(kMost);
}

Status remember_opened(std::span<const std::string> opened) {
  const auto file = recent_file();
  if (!file || opened.empty()) return Done{};
  Result<RecentFiles> recent = RecentFiles::load(*file);
  if (!recent) return recent.error();
  for (auto one = opened.rbegin(); one != opened.rend(); ++one) {
    std::error_code unknown;
    const bool address = one->find("://") != one->npos;
    recent->add(address ? *one : std::filesystem::absolute(*one, unknown).lexically_normal().string());
  }
  return recent->save(*file);
}

std::optional<std::filesystem::path> recent_file() {
  const auto folder = user_folder("XDG_STATE_HOME", ".local/state");
  return folder ? std::optional(*folder / "recent.json") : std::nullopt;
}

}  // namespace terrella
