#include "apps/open_scene/dated_files.h"

#include <fmt/format.h>
#include <time.h>  // strptime

#include <array>
#include <map>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/open_scene/passed_tiles.h"
#include "base/iso_time.h"
#include "base/time_steps.h"
#include "streaming/remote/tile_set_time.h"
#include "streaming/remote/web_address.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// All files of a set, and how one is opened.
struct DatedSet {
  std::string name;
  std::map<UtcTime, fs::path> files;
  std::shared_ptr<const TimeSteps> steps;
  OpenDatedFile open;
};

Result<std::unique_ptr<TileSource>> open_step(const std::shared_ptr<const DatedSet>& set, UtcTime time);

/// The tiles of one time, with the times of the others.
class DatedTiles : public PassedTiles {
 public:
  DatedTiles(std::shared_ptr<TileSource> tiles, TileSetInfo info, std::shared_ptr<const DatedSet> set)
      : PassedTiles(std::move(tiles), std::move(info)), set_(std::move(set)) {}
  [[nodiscard]] Result<std::unique_ptr<TileSource>> at_time(UtcTime time) override { return open_step(set_, time); }

 private:
  std::shared_ptr<const DatedSet> set_;
};

Result<std::unique_ptr<TileSource>> open_step(const std::shared_ptr<const DatedSet>& set, UtcTime time) {
  const TimeSteps& steps = *set->steps;
  const auto step = steps.at_or_before(time);
  if (!step) {
    return Error{fmt::format("{}: no file is of {} or earlier; the first time is {}", set->name,
                             time_text(time, TimePrecision::second, true), steps.text(steps.first()))};
  }
  auto tiles = set->open(set->files.at(*step));
  if (!tiles) return tiles.error();
  TileSetInfo info = (*tiles)->info();
  info.time = steps.text(*step);
  info.times = steps.summary();
  info.instant = step;
  info.steps = set->steps;
  return std::unique_ptr<TileSource>(std::make_unique<DatedTiles>(*std::move(tiles), std::move(info), set));
}

constexpr std::array kPlainFormats = {
    "%Y-%m-%dT%H-%M-%SZ", "%Y-%m-%dT%H-%M-%S", "%Y-%m-%dT%H-%MZ", "%Y-%m-%dT%H-%M", "%Y-%m-%d", "%Y-%m", "%Y"};

/// The last part of a time that the codes of a format give.
TimePrecision precision_of(std::string_view format) {
  const auto has = [format](std::string_view codes) {
    for (std::size_t at = format.find('%'); at < format.size() - 1; at = format.find('%', at + 2)) {
      if (codes.find(format[at + 1]) != codes.npos) return true;
    }
    return false;
  };
  if (has("Ss")) return TimePrecision::second;
  if (has("HM")) return TimePrecision::minute;
  if (has("dj")) return TimePrecision::day;
  return has("mbB") ? TimePrecision::month : TimePrecision::year;
}

/// A format of strptime() for whole names.
struct NameFormat {
  std::string text;
  std::string of_time;  ///< the parts of `text` that placeholders gave
};

/// The format of names, with `plain` for {time}. The error names the placeholder.
Result<NameFormat> format_of(std::string_view name, std::string_view plain) {
  constexpr std::string_view kBeforeFormat = "time:";
  NameFormat format;
  const auto add_letters = [&format](std::string_view letters) {
    for (const char c : letters) format.text.append(c == '%' ? 2 : 1, c);
  };
  for (std::size_t at = name.find("{time"); at != name.npos; at = name.find("{time")) {
    const std::size_t end = std::min(name.find('}', at), name.size() - 1);
    const std::string_view placeholder = name.substr(at + 1, end - at - 1);
    const std::string fault = is_time_placeholder(placeholder) ? fault_of_time_placeholder(placeholder) : "is unknown";
    if (!fault.empty()) return Error{fmt::format("{{{}}} {}", placeholder, fault)};
    const std::string_view given = placeholder == "time" ? plain : placeholder.substr(kBeforeFormat.size());
    add_letters(name.substr(0, at));
    format.text += given;
    format.of_time += given;
    name.remove_prefix(end + 1);
  }
  add_letters(name);
  return format;
}

/// The time in a name that fits a format; empty for other names.
std::string time_in(const std::string& name, const NameFormat& format) {
  std::tm fields{};
  fields.tm_mday = 1;
  const char* end = ::strptime(name.c_str(), format.text.c_str(), &fields);
  if (end == nullptr || *end != '\0') return {};
  const auto time =
      std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::from_time_t(::timegm(&fields)));
  return time_text(time, precision_of(format.of_time), format.of_time.ends_with('Z'));
}

}  // namespace

bool names_dated_files(const Url& address) {
  return !is_remote(address) && fs::path(address.with_secrets()).filename().string().find("{time") != std::string::npos;
}

Result<std::vector<DatedFile>> find_dated_files(const fs::path& pattern) {
  const std::string name = pattern.filename().string();
  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  std::vector<DatedFile> files;
  for (const char* plain : kPlainFormats) {
    const Result<NameFormat> format = format_of(name, plain);
    if (!format) return Error{fmt::format("{}: {}", pattern.string(), format.error().message)};
    std::error_code failed;
    for (fs::directory_iterator file(folder, failed), end; !failed && file != end; file.increment(failed)) {
      std::string time = time_in(file->path().filename().string(), *format);
      if (!time.empty()) files.push_back({.time = std::move(time), .file = file->path()});
    }
    if (failed) return Error{fmt::format("{}: {}", folder.string(), failed.message())};
    if (name.find("{time}") == name.npos) break;
  }
  return files;
}

Result<std::shared_ptr<TileSource>> open_dated_files(const std::string& name, const std::vector<DatedFile>& files,
                                                     const std::string& time, OpenDatedFile open) {
  if (files.empty()) return Error{name + ": no file has such a name"};
  auto set = std::make_shared<DatedSet>(DatedSet{.name = name, .files = {}, .steps = {}, .open = std::move(open)});
  std::vector<std::string> times;
  times.reserve(files.size());
  for (const DatedFile& dated : files) {
    const auto named = read_named_time(dated.time);
    if (!named) return Error{fmt::format("{}: its time {} cannot be read", dated.file.string(), dated.time)};
    if (const auto [other, is_new] = set->files.emplace(named->from, dated.file); !is_new) {
      return Error{fmt::format("{}: {} and {} are of one time; leave one of them out", name, dated.file.string(),
                               other->second.string())};
    }
    times.push_back(dated.time);
  }
  Result<TimeSteps> read = TimeSteps::parse(times, UtcTime());
  if (!read) return Error{fmt::format("{}: {}", name, read.error().message)};
  set->steps = std::make_shared<const TimeSteps>(*std::move(read));
  const auto wanted = read_named_time(time);
  auto tiles = open_step(set, wanted ? wanted->from : set->steps->last());
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

Result<std::shared_ptr<TileSource>> open_dated_caches(const fs::path& cache, const std::string& time) {
  const auto files =
      find_dated_files(cache.parent_path() / (cache.stem().string() + ".{time}" + cache.extension().string()));
  if (!files || files->empty()) return std::shared_ptr<TileSource>();
  return open_dated_files(cache.string(), *files, time,
                          [](const fs::path& file) -> Result<std::shared_ptr<TileSource>> {
                            auto tiles = open_tile_set(file);
                            if (!tiles) return tiles.error();
                            return std::shared_ptr<TileSource>(*std::move(tiles));
                          });
}

}  // namespace terrella
