#include "apps/viewer/flights/film_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/process/exit_code.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
constexpr const char* kLog = "film.log";

/// The number in "rendering film.mp4: 30 %", the report of the program's progress; nothing in another line.
std::optional<int> percent_in(const std::string& line) {
  constexpr std::string_view kUnit = " %";
  const std::size_t colon = line.rfind(": ");
  if (!line.starts_with("rendering ") || !line.ends_with(kUnit) || colon == std::string::npos) return std::nullopt;
  int percent = 0;
  const char* end = line.data() + line.size() - kUnit.size();
  const auto read = std::from_chars(line.data() + colon + 2, end, percent);
  return read.ec == std::errc() && read.ptr == end ? std::optional(percent) : std::nullopt;
}

}  // namespace

Result<std::unique_ptr<FilmJob>> FilmJob::start(const fs::path& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "render");
  auto job = ProgramJob::start(std::move(arguments), folder / kLog);
  if (!job) return Error{"No film can be started: " + job.error().message};
  return std::unique_ptr<FilmJob>(new FilmJob(folder, *std::move(job)));
}

int FilmJob::percent() {
  if (!job_->has_news()) return percent_;
  for (const std::string& line : job_->messages()) percent_ = std::max(percent_, percent_in(line).value_or(0));
  return percent_;
}

Result<std::string> FilmJob::end() {
  const int code = job_->exit_code();
  const std::string name = folder_.filename().string();
  if (code == kDone) return "The film is in " + name;
  if (is_stopped()) return fmt::format("Film cancelled; {}/{} has its command", name, kLog);
  if (code == kDoneInPart)
    return fmt::format("The film is in {}, but something is missing; {}/{} says what", name, name, kLog);
  std::vector<std::string> said = job_->messages();
  std::erase_if(said, [](const std::string& line) { return line.empty() || percent_in(line); });
  return Error{fmt::format("No film is in {}: {}", name, said.size() < 2 ? "it ended without a message" : said.back())};
}

}  // namespace terrella
