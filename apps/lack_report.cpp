#include "apps/lack_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "apps/console.h"

namespace terrella {
namespace {

constexpr std::size_t kMostReasons = 100;

/// What is wrong, without the address that is another for each tile: "http://host/5/3/2.jpg: status 503" is "status
/// 503".
std::string reason_of(const std::string& why) {
  const std::size_t scheme = why.find("://");
  const std::size_t end = scheme == std::string::npos ? scheme : why.find(": ", scheme);
  return end == std::string::npos ? why : why.substr(end + 2);
}

}  // namespace

const char* lack_name(Lack kind) {
  switch (kind) {
    case Lack::broken:
      return "broken";
    case Lack::refused:
      return "refused";
    case Lack::failed:
      break;
  }
  return "failed";
}

Result<LackReport> LackReport::open(const std::filesystem::path& file) {
  LackReport report;
  report.path_ = file;
  if (file.empty()) return report;
  report.file_.open(file, std::ios::trunc);
  if (!report.file_) {
    return Error{
        fmt::format("{}: cannot be written: {}; --missing names a file to make", file.string(), std::strerror(errno))};
  }
  return report;
}

void LackReport::add(const TileId& id, Lack kind, const std::string& told) {
  const std::string why = one_line(told);
  if (file_.is_open()) file_ << fmt::format("{}/{}/{}\t{}\t{}\n", id.level, id.x, id.y, lack_name(kind), why);
  std::string reason = reason_of(why);
  if (groups_.size() >= kMostReasons && !groups_.contains({kind, reason})) reason = "other reasons";
  Group& group = groups_[{kind, reason}];
  if (group.tiles++ == 0) {
    group.kind = kind;
    group.why = reason;
    group.first = id;
  }
}

std::vector<LackReport::Group> LackReport::groups() const {
  std::vector<Group> groups;
  for (const auto& [key, group] : groups_) groups.push_back(group);
  std::ranges::stable_sort(groups, std::ranges::greater(), &Group::tiles);
  return groups;
}

Status LackReport::close() {
  if (!file_.is_open()) return Done{};
  file_.close();
  if (file_.fail()) return Error{fmt::format("{}: could not be written to the end; is the disk full?", path_.string())};
  return Done{};
}

}  // namespace terrella
