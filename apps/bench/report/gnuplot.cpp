#include "apps/bench/report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace terrella::bench {
namespace {

constexpr int kPlotWidth_px = 620;
constexpr int kPlotHeight_px = 460;

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

std::optional<double> number_of(const Cell& cell) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&cell); number != nullptr && std::isfinite(*number)) return *number;
  return std::nullopt;
}

std::string text_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const auto number = number_of(cell);
  return number ? fmt::format("{:g}", *number) : "";
}

bool passes(const Report& report, const std::vector<Cell>& row, const RowFilter& filter) {
  return std::ranges::find(filter.values, text_of(row[report.column(filter.column)])) != filter.values.end();
}

bool shows(double value, bool logarithmic) { return !logarithmic || value > 0.0; }

std::vector<Curve> curves_of(const Report& report, const Plot& plot) {
  std::vector<Curve> curves;
  const std::size_t x = report.column(plot.x), y = report.column(plot.y);
  for (const std::vector<Cell>& row : report.rows) {
    if (!std::ranges::all_of(plot.only, [&](const RowFilter& filter) { return passes(report, row, filter); })) continue;
    const auto at_x = number_of(row[x]), at_y = number_of(row[y]);
    if (!at_x || !at_y || !shows(*at_x, plot.log_x) || !shows(*at_y, plot.log_y)) continue;
    const std::string name = plot.series.empty() ? "" : text_of(row[report.column(plot.series)]);
    auto curve = std::ranges::find(curves, name, &Curve::name);
    if (curve == curves.end()) curve = curves.insert(curves.end(), Curve{name, {}});
    curve->points.emplace_back(*at_x, *at_y);
  }
  return curves;
}

/// Quotes a text for gnuplot.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + '"';
}

std::string axis_name(const Report& report, const std::string& column_name) {
  const Column& column = report.columns[report.column(column_name)];
  return column.unit.empty() ? column.name : column.name + ", " + column.unit;
}

std::string data_of(const std::vector<Curve>& curves, std::size_t plot) {
  std::string text;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    text += fmt::format("$plot{}_{} << EOD\n", plot, k);
    for (const auto& [x, y] : curves[k].points) text += fmt::format("{} {}\n", x, y);
    text += "EOD\n";
  }
  return text;
}

/// A range with a margin; gnuplot's own range of a logarithmic axis ends at powers of ten.
std::string log_range(const char* axis, const std::vector<Curve>& curves, double std::pair<double, double>::*member) {
  constexpr double kMargin = 1.2;
  double least = HUGE_VAL, most = 0.0;
  for (const Curve& curve : curves) {
    for (const auto& point : curve.points) {
      least = std::min(least, point.*member);
      most = std::max(most, point.*member);
    }
  }
  std::string marks;
  for (double decade = std::pow(10.0, std::floor(std::log10(least / kMargin))); decade < most * kMargin; decade *= 10) {
    for (const double step : {1.0, 2.0, 5.0}) marks += fmt::format("{}{:g}", marks.empty() ? "" : ",", step * decade);
  }
  return fmt::format("set {0}range [{1}:{2}]\nset {0}tics ({3})\n", axis, least / kMargin, most * kMargin, marks);
}

std::string commands_of(const Report& report, const Plot& plot, const std::vector<Curve>& curves, std::size_t number) {
  std::string text =
      fmt::format("set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n", quoted(plot.title),
                  quoted(axis_name(report, plot.x)), quoted(axis_name(report, plot.y)));
  text += plot.log_x ? "set logscale x\n" : "unset logscale x\n";
  text += plot.log_y ? "set logscale y\n" : "unset logscale y\n";
  using Point = std::pair<double, double>;
  text +=
      plot.log_x && !curves.empty() ? log_range("x", curves, &Point::first) : "set xrange [*:*]\nset xtics autofreq\n";
  text +=
      plot.log_y && !curves.empty() ? log_range("y", curves, &Point::second) : "set yrange [0:*]\nset ytics autofreq\n";
  // gnuplot fails on an axis without points.
  if (curves.empty())
    return text + "unset logscale\nset xrange [0:1]\nset yrange [0:1]\nplot NaN notitle\nset xrange [*:*]\n";
  text += "plot ";
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const std::string title = curves[k].name.empty() ? "notitle" : "title " + quoted(curves[k].name) + " noenhanced";
    text += fmt::format("{}$plot{}_{} using 1:2 with {} lt {} pt {} {}", k == 0 ? "" : ", \\\n  ", number, k,
                        plot.lines ? "linespoints" : "points", k + 1, k % 13 + 4, title);
  }
  return text + '\n';
}

}  // namespace

std::string gnuplot_script(const Report& report, const std::string& picture) {
  std::string data, commands;
  for (std::size_t k = 0; k < report.plots.size(); ++k) {
    const std::vector<Curve> curves = curves_of(report, report.plots[k]);
    data += data_of(curves, k);
    commands += commands_of(report, report.plots[k], curves, k);
  }
  const auto plots = static_cast<int>(report.plots.size());
  const int across = std::min(plots, 2), down = (plots + 1) / 2;
  const char* terminal = picture.ends_with(".svg") ? "svg noenhanced" : "pngcairo";
  return data +
         fmt::format("set terminal {} size {},{} font \"DejaVu Sans,9\"\nset output {}\n", terminal,
                     across * kPlotWidth_px, down * kPlotHeight_px, quoted(picture)) +
         fmt::format(
             "set multiplot layout {},{}\nset grid\nset key outside bottom center horizontal\nset bmargin 8\nset "
             "offsets graph "
             "0.03, graph 0.03, graph 0.03, graph 0\n",
             down, across) +
         commands + "unset multiplot\n";
}

Drawn run_gnuplot(const std::filesystem::path& script) {
  std::string program = "gnuplot", folder = script.parent_path().string(), file = script.filename().string();
  const std::array<char*, 3> arguments{program.data(), file.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  // gnuplot's messages concern the script; the report names the script instead.
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = 0;
  const int refused = posix_spawnp(&pid, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (refused != 0) return Drawn::no_gnuplot;
  int status = 0;
  if (waitpid(pid, &status, 0) != pid || !WIFEXITED(status)) return Drawn::failed;
  constexpr int kNotFound = 127;  // exit code if the spawn failed late
  if (WEXITSTATUS(status) == kNotFound) return Drawn::no_gnuplot;
  return WEXITSTATUS(status) == 0 ? Drawn::yes : Drawn::failed;
}

}  // namespace terrella::bench
