#include "apps/film/film_record.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <system_error>
#include <vector>

#include "apps/process/write_file.h"
#include "apps/process/write_picture.h"
#include "streaming/raster/picture_kind.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecord = "film.json";
constexpr const char* kIncomplete = ".incomplete";

fs::path mark_of(const fs::path& frame) { return frame.string() + kIncomplete; }

/// Facts of the film in a folder; none without a record, and without facts if the record is damaged.
std::optional<FilmFacts> read_record(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const auto record = nlohmann::json::parse(file, nullptr, false);
  FilmFacts facts;
  if (!record.is_object()) return facts;
  for (const auto& [name, value] : record.items()) {
    if (value.is_string()) facts[name] = value.get<std::string>();
  }
  return facts;
}

Status write_record(const fs::path& path, const FilmFacts& facts) {
  const std::string text = nlohmann::json(facts).dump(1) + "\n";
  return write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

/// Names of the facts that differ.
std::string differences(const FilmFacts& a, const FilmFacts& b) {
  FilmFacts all = a;
  all.insert(b.begin(), b.end());
  std::string names;
  for (const auto& [name, value] : all) {
    const auto in_a = a.find(name), in_b = b.find(name);
    if (in_a != a.end() && in_b != b.end() && in_a->second == in_b->second) continue;
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

/// Process that wrote a file NAME.PID.part; none for another file.
std::optional<pid_t> writer_of(const std::string& rest) {
  if (!rest.starts_with('.') || !rest.ends_with(".part") || rest.size() < 7) return std::nullopt;
  pid_t pid = 0;
  const char* const end = rest.data() + rest.size() - 5;
  const auto read = std::from_chars(rest.data() + 1, end, pid);
  return read.ec == std::errc() && read.ptr == end && pid > 0 ? std::optional(pid) : std::nullopt;
}

/// Files of a film's frames in their folder.
std::vector<fs::path> frames_there(const FrameNames& names) {
  std::vector<fs::path> frames;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(names.folder(), failed)) {
    if (names.frame_of(entry.path().filename().string())) frames.push_back(entry.path());
  }
  return frames;
}

}  // namespace

Result<FilmFolder> FilmFolder::open(FrameNames names, const FilmFacts& facts, bool force) {
  FilmFolder folder(std::move(names));
  std::error_code failed;
  fs::create_directories(folder.names_.folder(), failed);
  if (failed) return Error{fmt::format("{}: {}", folder.names_.folder().string(), failed.message())};
  if (const Status mine = folder.claim(facts, force); !mine) return mine.error();
  folder.list_parts();
  return folder;
}

Status FilmFolder::claim(const FilmFacts& facts, bool force) {
  const fs::path path = names_.folder() / kRecord;
  // Listed first: another shard writes the record before its first frame.
  const std::vector<fs::path> frames = frames_there(names_);
  const auto recorded = read_record(path);
  if (recorded == facts) return Done{};
  if (!force && recorded) {
    return Error{
        fmt::format("{}: the frames there are of another film ({} differ); --force replaces them, or name "
                    "another folder",
                    path.string(), differences(*recorded, facts))};
  }
  if (!force && !frames.empty()) {
    return Error{
        fmt::format("{}: is there already, and no {} says of which film; --force replaces such pictures, or "
                    "name another folder",
                    frames.front().string(), kRecord)};
  }
  std::error_code failed;
  for (const fs::path& frame : frames) {
    fs::remove(frame, failed);
    fs::remove(mark_of(frame), failed);
  }
  return write_record(path, facts);
}

void FilmFolder::list_parts() {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(names_.folder(), failed)) {
    const std::string file = entry.path().filename().string();
    const std::size_t dot = file.ends_with(".part") ? file.rfind('.', file.size() - 6) : std::string::npos;
    if (dot == std::string::npos) continue;
    const auto frame = names_.frame_of(file.substr(0, dot));
    const auto pid = writer_of(file.substr(dot));
    if (frame && pid && kill(*pid, 0) != 0 && errno == ESRCH) parts_.emplace(*frame, file);
  }
}

bool FilmFolder::has(std::int64_t frame) const {
  const fs::path path = names_.path(frame);
  std::error_code failed;
  return begins_as_picture(path) && !fs::exists(mark_of(path), failed);
}

void FilmFolder::remove_parts(std::int64_t frame) {
  const auto [first, last] = parts_.equal_range(frame);
  std::error_code failed;
  for (auto part = first; part != last; ++part) fs::remove(names_.folder() / part->second, failed);
}

// The mark is there as long as a frame that lacks tiles.
Status FilmFolder::write(std::int64_t frame, const Image& image, bool complete) {
  const fs::path path = names_.path(frame);
  if (!complete) {
    if (Status marked = write_file(mark_of(path), {}); !marked) return marked;
  }
  if (Status written = write_picture(path, image); !written) return written;
  std::error_code failed;
  if (complete) fs::remove(mark_of(path), failed);
  return Done{};
}

}  // namespace terrella
