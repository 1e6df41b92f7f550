#include "apps/viewer/tools/recent_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <system_error>

#include "apps/setup/user_folder.h"
#include "apps/setup/write_file.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"
#include "streaming/url.h"

namespace terrella {
namespace {

constexpr std::size_t kMostRecentBytes = 1UL << 20;
constexpr const char* kRecentField = "recent";

}  // namespace

Result<RecentFiles> RecentFiles::load(const std::filesystem::path& file) {
  RecentFiles recent;
  const auto bytes = read_file(file, kMostRecentBytes);
  if (!bytes && bytes.error().problem == FileProblem::missing) return recent;
  if (!bytes) return Error{bytes.error().message};
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const Result<nlohmann::json> json = parse_json_object(text, kMostRecentBytes, file.string());
  if (!json) return json.error();
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
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) return Error{file.parent_path().string() + ": " + failed.message()};
  const nlohmann::json json = {{kRecentField, all_}};
  const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return write_file(file, std::as_bytes(std::span(text)));
}

void RecentFiles::add(const std::string& opened) {
  if (opened.empty() || Url(opened).redacted() != opened) return;
  std::erase(all_, opened);
  all_.insert(all_.begin(), opened);
  if (all_.size() > kMost) all_.resize(kMost);
}

std::optional<std::filesystem::path> recent_file() {
  const auto folder = user_folder("XDG_STATE_HOME", ".local/state");
  return folder ? std::optional(*folder / "recent.json") : std::nullopt;
}

}  // namespace terrella
