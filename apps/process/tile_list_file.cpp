#include "apps/process/tile_list_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <string_view>

#include "streaming/file_bytes.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// True for an empty file, or if the first line begins with LEVEL/X/Y.
bool is_list(const fs::path& path) {
  std::error_code failed;
  // Devices and pipes have no contents to lose.
  if (!fs::is_regular_file(path, failed)) return true;
  constexpr std::size_t kLongestId = 64;
  const auto head = read_head(path, kLongestId);
  if (!head) return false;
  std::string_view text = as_text(*head);
  if (text.empty()) return true;
  for (const std::string_view end : {"/", "/", "\t\n"}) {
    const std::size_t digits = text.find_first_not_of("0123456789");
    if (digits == 0 || digits == std::string_view::npos || end.find(text[digits]) == std::string_view::npos)
      return false;
    text.remove_prefix(digits + 1);
  }
  return true;
}

}  // namespace

Result<TileListFile> TileListFile::open(const fs::path& path, Mode mode) {
  TileListFile list;
  if (path.empty()) return list;
  if (!is_list(path)) {
    return Error{fmt::format("{}: is there already and is no list of tiles; name another file", path.string())};
  }
  list.path_ = path;
  list.file_.reset(std::fopen(path.c_str(), mode == Mode::begin ? "we" : "ae"));
  if (!list.file_) return Error{fmt::format("{}: cannot be written: {}", path.string(), why_not_written(errno))};
  return list;
}

void TileListFile::note_failure() {
  if (!failed_) error_number_ = errno;
  failed_ = true;
}

void TileListFile::add(const TileId& id, const std::string& rest) {
  if (!file_) return;
  const std::string line = fmt::format("{}/{}/{}{}\n", id.level, id.x, id.y, rest);
  const bool written = std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size();
  if (!written || std::fflush(file_.get()) != 0) note_failure();
}

Status TileListFile::close() {
  if (!file_) return Done{};
  if (std::fclose(file_.release()) != 0) note_failure();
  if (!failed_) return Done{};
  return Error{fmt::format("{}: not all lines could be written: {}", path_.string(), why_not_written(error_number_))};
}

}  // namespace terrella
