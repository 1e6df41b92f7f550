#include "streaming/mosaic/mosaic_store.h"

#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

namespace terrella {
namespace {

/// The folder of a cache is used by one user, so another process never holds the file for long.
constexpr std::chrono::milliseconds kPatience{2000};

constexpr std::array kSchema = {
    std::string_view("PRAGMA journal_mode=WAL"), std::string_view("PRAGMA wal_autocheckpoint=1000"),
    std::string_view("PRAGMA synchronous=NORMAL"),
    std::string_view(
        "CREATE TABLE IF NOT EXISTS header(path TEXT PRIMARY KEY, mark INTEGER NOT NULL, facts TEXT NOT NULL)"),
    std::string_view("CREATE TABLE IF NOT EXISTS tile(level INTEGER, x INTEGER, y INTEGER, mark INTEGER NOT NULL, "
                     "bytes BLOB NOT NULL, "
                     "PRIMARY KEY(level, x, y))")};

std::int64_t as_signed(std::uint64_t mark) { return static_cast<std::int64_t>(mark); }

/// Increase this number if the meaning of a field changes.
constexpr int kFactsVersion = 2;

/// JSON has no NaN, which may mean "no data".
nlohmann::json number_or_null(const std::optional<double>& number) {
  if (number && std::isnan(*number)) return "nan";
  return number ? nlohmann::json(*number) : nlohmann::json();
}

std::optional<double> number_of(const nlohmann::json& number) {
  if (number.is_string()) return std::numeric_limits<double>::quiet_NaN();
  return number.is_null() ? std::nullopt : std::optional(number.get<double>());
}

}  // namespace

Result<std::unique_ptr<MosaicStore>> MosaicStore::open(const std::filesystem::path& path) {
  auto database = SqliteWriter::open(path, SqliteWriter::Mode::create);
  if (!database) return Error{path.string() + ": " + database.error().message};
  database->wait_for_locks(kPatience);
  for (const std::string_view sql : kSchema) {
    const auto done = database->run(sql);
    if (!done) return Error{path.string() + ": " + done.error().message};
  }
  return std::unique_ptr<MosaicStore>(new MosaicStore(*std::move(database)));
}

MosaicStore::Headers MosaicStore::headers() {
  const std::lock_guard lock(mutex_);
  Headers headers;
  auto rows = database_.prepare("SELECT path, mark, facts FROM header");
  if (!rows) return headers;
  for (auto more = rows->step(); more && *more; more = rows->step()) {
    headers.emplace(rows->text(0), std::pair(static_cast<std::uint64_t>(rows->integer(1)), rows->text(2)));
  }
  return headers;
}

void MosaicStore::keep_headers(const std::vector<Header>& headers) {
  const std::lock_guard lock(mutex_);
  auto insert = database_.prepare("INSERT OR REPLACE INTO header(path, mark, facts) VALUES(?1, ?2, ?3)");
  if (!insert || !database_.run("BEGIN IMMEDIATE")) return;
  for (const Header& header : headers) {
    insert->bind(1, std::string_view(header.path));
    insert->bind(2, as_signed(header.mark));
    insert->bind(3, std::string_view(header.text));
    if (!insert->run()) break;
  }
  if (!database_.run("COMMIT")) static_cast<void>(database_.run("ROLLBACK"));
}

std::optional<std::vector<std::byte>> MosaicStore::tile(const TileId& id, std::uint64_t mark) {
  const std::lock_guard lock(mutex_);
  auto row = database_.prepare("SELECT bytes FROM tile WHERE level = ?1 AND x = ?2 AND y = ?3 AND mark = ?4");
  if (!row) return {};
  row->bind(1, std::int64_t{id.level});
  row->bind(2, id.x);
  row->bind(3, id.y);
  row->bind(4, as_signed(mark));
  const auto found = row->step();
  if (!found || !*found) return {};
  const std::string text = row->text(0);
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

void MosaicStore::keep_tile(const TileId& id, std::uint64_t mark, const std::vector<std::byte>& bytes) {
  const std::lock_guard lock(mutex_);
  auto insert = database_.prepare("INSERT OR REPLACE INTO tile(level, x, y, mark, bytes) VALUES(?1, ?2, ?3, ?4, ?5)");
  if (!insert) return;
  insert->bind(1, std::int64_t{id.level});
  insert->bind(2, id.x);
  insert->bind(3, id.y);
  insert->bind(4, as_signed(mark));
  insert->bind(5, std::span<const std::byte>(bytes));
  static_cast<void>(insert->run());
}

std::string header_text(const PlacedFile& placed) {
  const MosaicFile& file = placed.file;
  const MosaicPlace& place = placed.place;
  const Affine& t = place.at.to_crs;
  const nlohmann::json text = {{"version", kFactsVersion},
                               {"bytes", file.bytes},
                               {"changed", file.changed_ns},
                               {"sizes", file.sizes},
                               {"kinds", {file.is_numbers, file.one_band, file.by_rows}},
                               {"unit", file.unit},
                               {"coding", {file.scale, file.offset}},
                               {"nodata", {number_or_null(file.nodata), number_or_null(file.own_nodata)}},
                               {"crs", place.at.crs},
                               {"place", {t.x0, t.x_per_column, t.x_per_row, t.y0, t.y_per_column, t.y_per_row}},
                               {"box", {place.box.west, place.box.south, place.box.east, place.box.north}},
                               {"centric", place.latitude == LatitudeKind::centric},
                               {"pixel", {place.pixel_units, place.unit_m}}};
  // A unit may contain bytes that are not UTF-8.
  return text.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<PlacedFile> parse_header_text(const std::string& text) {
  const nlohmann::json facts = nlohmann::json::parse(text, nullptr, false);
  if (!facts.is_object() || facts.value("version", 0) != kFactsVersion) return {};
  try {
    PlacedFile placed;
    MosaicFile& file = placed.file;
    MosaicPlace& place = placed.place;
    Affine& t = place.at.to_crs;
    facts.at("bytes").get_to(file.bytes);
    facts.at("changed").get_to(file.changed_ns);
    facts.at("sizes").get_to(file.sizes);
    file.is_numbers = facts.at("kinds").at(0).get<bool>();
    file.one_band = facts.at("kinds").at(1).get<bool>();
    file.by_rows = facts.at("kinds").at(2).get<bool>();
    facts.at("unit").get_to(file.unit);
    facts.at("coding").at(0).get_to(file.scale);
    facts.at("coding").at(1).get_to(file.offset);
    file.nodata = number_of(facts.at("nodata").at(0));
    file.own_nodata = number_of(facts.at("nodata").at(1));
    facts.at("crs").get_to(place.at.crs);
    double* const numbers[] = {&t.x0, &t.x_per_column, &t.x_per_row, &t.y0, &t.y_per_column, &t.y_per_row};
    for (std::size_t i = 0; i < std::size(numbers); ++i) facts.at("place").at(i).get_to(*numbers[i]);
    double* const sides[] = {&place.box.west, &place.box.south, &place.box.east, &place.box.north};
    for (std::size_t i = 0; i < std::size(sides); ++i) facts.at("box").at(i).get_to(*sides[i]);
    place.latitude = facts.at("centric").get<bool>() ? LatitudeKind::centric : LatitudeKind::graphic;
    facts.at("pixel").at(0).get_to(place.pixel_units);
    facts.at("pixel").at(1).get_to(place.unit_m);
    if (file.sizes.empty() || !t.is_finite()) return {};
    return placed;
  } catch (const nlohmann::json::exception&) {
    return {};  // written by another version
  }
}

}  // namespace terrella
