#include "base/utc_time.h"

#include <cmath>
#include <ctime>
#include <iomanip>
#include <locale>
#include <optional>
#include <sstream>
#include <string>

#include "base/number.h"

namespace terrella {
namespace {

// The accepted forms; '0' stands for a digit. std::get_time alone would also accept "2026-6-1" and "+026-06-01".
constexpr std::string_view kDay = "0000-00-00";
constexpr std::string_view kMinute = "0000-00-00T00:00";
constexpr std::string_view kSecond = "0000-00-00T00:00:00";

bool has_form(std::string_view text, std::string_view form) {
  if (text.size() < form.size()) return false;
  for (std::size_t k = 0; k < form.size(); ++k) {
    const bool digit = text[k] >= '0' && text[k] <= '9';
    if (form[k] == '0' ? !digit : text[k] != form[k] && !(form[k] == 'T' && text[k] == ' ')) return false;
  }
  return true;
}

std::optional<std::tm> calendar_fields(std::string text, const char* format) {
  if (text.size() > kDay.size()) text[kDay.size()] = 'T';
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::tm fields{};
  in >> std::get_time(&fields, format);
  if (in.fail()) return std::nullopt;
  return fields;
}

std::optional<UtcTime> instant(const std::tm& fields, double fraction_s) {
  using namespace std::chrono;
  const year_month_day date{year{fields.tm_year + 1900}, month{static_cast<unsigned>(fields.tm_mon + 1)},
                            day{static_cast<unsigned>(fields.tm_mday)}};
  if (!date.ok() || fields.tm_year + 1900 < 1 || fields.tm_hour > 23 || fields.tm_min > 59 || fields.tm_sec > 59) {
    return std::nullopt;
  }
  return sys_days{date} + hours{fields.tm_hour} + minutes{fields.tm_min} + seconds{fields.tm_sec} +
         milliseconds{static_cast<int>(std::floor(fraction_s * 1000.0))};
}

// Reads the text after the seconds: a fraction such as ".25", or nothing.
std::optional<double> fraction(std::string_view text) {
  if (text.empty()) return 0.0;
  if (text.size() < 2 || text.find_first_not_of("0123456789", 1) != std::string_view::npos) return std::nullopt;
  if (text.front() != '.' && text.front() != ',') return std::nullopt;
  return read_number("0." + std::string(text.substr(1)));
}

std::optional<UtcTime> read_utc(std::string_view text) {
  if (text.size() > kDay.size() + 1 && (text.back() == 'Z' || text.back() == 'z')) text.remove_suffix(1);
  double fraction_s = 0.0;
  const char* format = "%Y-%m-%dT%H:%M:%S";
  if (has_form(text, kSecond)) {
    const auto read = fraction(text.substr(kSecond.size()));
    if (!read) return std::nullopt;
    fraction_s = *read;
    text = text.substr(0, kSecond.size());
  } else if (text.size() == kMinute.size() && has_form(text, kMinute)) {
    format = "%Y-%m-%dT%H:%M";
  } else if (text.size() == kDay.size() && has_form(text, kDay)) {
    format = "%Y-%m-%d";
  } else {
    return std::nullopt;
  }
  const auto fields = calendar_fields(std::string(text), format);
  return fields ? instant(*fields, fraction_s) : std::nullopt;
}

}  // namespace

Result<UtcTime> parse_utc(std::string_view text) {
  if (const auto read = read_utc(text)) return *read;
  return Error{"time " + in_quotes(text) + " is not an instant of UTC; write it as 2026-06-21T12:00:00Z"};
}

}  // namespace terrella
