#include "apps/preload/missing_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/process/console.h"

namespace terrella {
namespace {

constexpr std::size_t kMostReasons = 100;

/// Removes the address, which differs for each tile: "http://host/5/3/2.jpg: status 503" becomes "status 503".
std::string reason_of(const std::string& why) {
  const std::size_t scheme = why.find("://");
  const std::size_t end = scheme == std::string::npos ? scheme : why.find(": ", scheme);
  return end == std::string::npos ? why : why.substr(end + 2);
}

}  // namespace

const char* missing_name(PreloadMissing kind) {
  switch (kind) {
    case PreloadMissing::broken:
      return "broken";
    case PreloadMissing::refused:
      return "refused";
    case PreloadMissing::no_room:
      return "no room";
    case PreloadMissing::failed:
      break;
  }
  return "failed";
}

Result<MissingReport> MissingReport::open(const std::filesystem::path& file) {
  auto list = TileListFile::open(file, TileListFile::Mode::begin);
  if (!list) return list.error();
  MissingReport report;
  report.list_ = *std::move(list);
  return report;
}

void MissingReport::add(const TileId& id, PreloadMissing kind, const std::string& told) {
  const std::string why = one_line(told);
  list_.add(id, fmt::format("\t{}\t{}", missing_name(kind), why));
  std::string reason = reason_of(why);
  if (groups_.size() >= kMostReasons && !groups_.contains({kind, reason})) reason = "other reasons";
  Group& group = groups_[{kind, reason}];
  if (group.tiles++ == 0) {
    group.kind = kind;
    group.why = reason;
    group.first = id;
  }
}

std::vector<MissingReport::Group> MissingReport::groups() const {
  std::vector<Group> groups;
  for (const auto& [key, group] : groups_) groups.push_back(group);
  std::ranges::stable_sort(groups, std::ranges::greater(), &Group::tiles);
  return groups;
}

}  // namespace terrella
