#include "apps/bench/report/report_files.h"

#include <fmt/format.h>

#include <span>
#include <system_error>

#include "apps/bench/report/gnuplot.h"
#include "apps/process/write_file.h"
#include "streaming/file_bytes.h"

namespace terrella::bench {
namespace {

namespace fs = std::filesystem;

Status write_text(const fs::path& file, const std::string& text, ReportFiles& files) {
  Status written = write_file(file, std::as_bytes(std::span(text)));
  if (written) files.written.push_back(file);
  return written;
}

}  // namespace

Status make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder, error)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) return Error{fmt::format("{}: cannot make this folder ({})", folder.string(), error.message())};
  return Done{};
}

Result<ReportFiles> write_report(const Report& report, const fs::path& folder) {
  const auto file = [&](const char* ending) { return folder / (report.name + ending); };
  ReportFiles files;
  const fs::path script = file(".gnuplot"), picture = file(".png");
  if (Status done = write_text(file(".csv"), as_csv(report), files); !done) return done.error();
  if (Status done = write_text(file(".json"), as_json(report), files); !done) return done.error();
  if (Status done = write_text(script, gnuplot_script(report, picture.filename().string()), files); !done) {
    return done.error();
  }
  switch (run_gnuplot(script)) {
    case Drawn::yes:
      files.written.push_back(picture);
      break;
    case Drawn::no_gnuplot:
      files.remark = fmt::format(
          "there is no gnuplot to draw the picture; install it (gnuplot-nox) and run: gnuplot {}", script.string());
      break;
    case Drawn::failed:
      files.remark = fmt::format("gnuplot could not draw {}", script.string());
      break;
  }
  return files;
}

std::string draw_svg(const Report& report, const fs::path& folder) {
  const fs::path picture = folder / (report.name + ".svg"), script = folder / (report.name + ".svg.gnuplot");
  ReportFiles files;
  const Status written = write_text(script, gnuplot_script(report, picture.filename().string()), files);
  const bool drawn = written && run_gnuplot(script) == Drawn::yes;
  std::error_code ignored;
  fs::remove(script, ignored);
  constexpr std::size_t kMostBytes = 64UL << 20;
  if (!drawn) return {};
  const auto bytes = read_file(picture, kMostBytes);
  return bytes ? std::string(terrella::as_text(*bytes)) : std::string();
}

}  // namespace terrella::bench
