#include "apps/open_scene/dated_files.h"

#include <fmt/format.h>
#include <locale.h>  // newlocale
#include <time.h>    // strptime_l

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/open_scene/passed_tiles.h"
#include "base/iso_time.h"
#include "base/time_steps.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/remote/tile_set_time.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// All files of a set, and how one is opened.
struct DatedSet {
  std::string name;
  std::map<UtcTime, fs::path> files;
  std::shared_ptr<const TimeSteps> steps;
  std::string times;  ///< summary of the steps
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
  info.times = set->times;
  info.instant = step;
  info.steps = set->steps;
  return std::unique_ptr<TileSource>(std::make_unique<DatedTiles>(*std::move(tiles), std::move(info), set));
}

constexpr std::string_view kPlain = "{time}", kWithFormat = "{time:";

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

/// A format of strftime() for whole names.
struct NameFormat {
  std::string text;
  TimePrecision precision;
};

/// The format of names with {time:FORMAT}. The error names the placeholder.
Result<NameFormat> format_of(std::string_view name) {
  std::string text, of_time;
  const auto add_letters = [&text](std::string_view letters) {
    for (const char c : letters) text.append(c == '%' ? 2 : 1, c);
  };
  for (std::size_t at = name.find(kWithFormat); at != name.npos; at = name.find(kWithFormat)) {
    const std::size_t end = std::min(name.find('}', at), name.size() - 1);
    const std::string_view placeholder = name.substr(at + 1, end - at - 1);
    const std::string fault = fault_of_time_placeholder(placeholder);
    if (!fault.empty()) return Error{fault};
    const std::string_view format = placeholder.substr(kWithFormat.size() - 1);
    add_letters(name.substr(0, at));
    text += format;
    of_time += format;
    name.remove_prefix(end + 1);
  }
  add_letters(name);
  return NameFormat{std::move(text), precision_of(of_time)};
}

/// The time in a name that has a format; empty for other names.
std::string time_by_format(const std::string& name, const NameFormat& format) {
  static const locale_t english = ::newlocale(LC_ALL_MASK, "C", nullptr);
  std::tm fields{};
  fields.tm_mday = 1;
  const char* end = ::strptime_l(name.c_str(), format.text.c_str(), &fields, english);
  if (end == nullptr || *end != '\0') return {};
  // strptime() gives the fields of %s in local time, and its zone; those of all others have none.
  const std::time_t seconds = fields.tm_zone != nullptr ? std::mktime(&fields) : ::timegm(&fields);
  const auto time = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::from_time_t(seconds));
  // strptime() takes 31 February, too, and one digit for two.
  const Result<std::string> written = format_time(time, format.text);
  return written && *written == name ? time_text(time, format.precision, false) : std::string();
}

/// The time between the parts of a name before and after {time}; empty for other names.
std::string time_between(const std::string& name, std::string_view before, std::string_view after) {
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) return {};
  std::string time = name.substr(before.size(), name.size() - before.size() - after.size());
  // A name has no colons.
  const std::size_t clock = std::min(time.find('T'), time.size());
  std::replace(time.begin() + static_cast<std::ptrdiff_t>(clock), time.end(), '-', ':');
  return read_named_time(time) ? time : std::string();
}

using TimeInName = std::function<std::string(const std::string& name)>;

/// Reads times in names by a pattern.
Result<TimeInName> reader_of(const std::string& pattern) {
  if (const std::size_t at = pattern.find(kPlain); at != pattern.npos) {
    const std::string before = pattern.substr(0, at), after = pattern.substr(at + kPlain.size());
    if (after.find("{time") != after.npos)
      return Error{"{time} stands alone, or write each {time:FORMAT} with a format"};
    return TimeInName([before, after](const std::string& name) { return time_between(name, before, after); });
  }
  Result<NameFormat> format = format_of(pattern);
  if (!format) return format.error();
  return TimeInName([format = *std::move(format)](const std::string& name) { return time_by_format(name, format); });
}

}  // namespace

bool names_dated_files(const Url& address) {
  const std::string& text = address.with_secrets();
  std::error_code failed;
  return has_time(fs::path(text).filename().string()) && !is_remote(address) && !fs::exists(text, failed);
}

Result<std::vector<DatedFile>> find_dated_files(const fs::path& pattern) {
  const Result<TimeInName> time_in = reader_of(pattern.filename().string());
  if (!time_in) return Error{fmt::format("{}: {}", pattern.string(), time_in.error().message)};
  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  std::vector<DatedFile> files;
  std::error_code failed;
  for (fs::directory_iterator file(folder, failed), end; !failed && file != end; file.increment(failed)) {
    std::string time = (*time_in)(file->path().filename().string());
    if (!time.empty()) files.push_back({.time = std::move(time), .file = file->path()});
  }
  if (failed) return Error{fmt::format("{}: {}", folder.string(), failed.message())};
  return files;
}

Result<std::shared_ptr<TileSource>> open_dated_files(const std::string& name, const std::vector<DatedFile>& files,
                                                     const std::string& time, OpenDatedFile open) {
  if (files.empty()) return Error{name + ": no file has such a name"};
  auto set = std::make_shared<DatedSet>(
      DatedSet{.name = name, .files = {}, .steps = {}, .times = {}, .open = std::move(open)});
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
  set->times = set->steps->summary();
  const auto wanted = read_named_time(time);
  auto tiles = open_step(set, wanted ? wanted->from : set->steps->last());
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

Result<std::shared_ptr<TileSource>> open_dated_caches(const fs::path& cache, const std::string& time) {
  auto files = find_dated_files(cache.parent_path() / (cache.stem().string() + ".{time}" + cache.extension().string()));
  if (!files || files->empty()) return std::shared_ptr<TileSource>();
  // "2026-06" and "2026-06-01" begin with one instant; the finer text is the better one.
  std::ranges::sort(*files, std::greater(), [](const DatedFile& file) { return file.time.size(); });
  std::set<UtcTime> instants;
  std::erase_if(*files,
                [&](const DatedFile& file) { return !instants.insert(read_named_time(file.time)->from).second; });
  return open_dated_files(cache.string(), *files, time,
                          [](const fs::path& file) -> Result<std::shared_ptr<TileSource>> {
                            auto tiles = open_tile_set(file);
                            if (!tiles) return tiles.error();
                            return std::shared_ptr<TileSource>(*std::move(tiles));
                          });
}

}  // namespace terrella
