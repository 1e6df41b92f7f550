#include "streaming/sets/gpkg_coverage.h"

#include <fmt/format.h>

#include <string>

namespace terrella {
namespace {

/// Checks the words in the row of the table. The error is the end of a message.
Status check_words(const SqliteQuery& row) {
  const std::string datatype = row.text(0).value_or("");
  if (datatype != "integer" && datatype != "float") {
    return Error{fmt::format("its datatype is \"{}\", it must be integer or float", datatype)};
  }
  if (row.text(5) == "grid-value-is-corner") {
    return Error{
        "its numbers stand at the corners of pixels (grid-value-is-corner), they must stand for whole pixels "
        "or their middles (gdal_translate -co GRID_CELL_ENCODING=grid-value-is-center)"};
  }
  return Done{};
}

/// Quantity of a coverage. `cut` writes "value" for an unknown one, and "Height" is the table's default.
std::string quantity_of(const std::string& stated) {
  if (stated == "value") return {};
  return stated == "Height" ? "height" : stated;
}

Result<NumberInfo> info_of(const SqliteQuery& row) {
  if (Status known = check_words(row); !known) return known.error();
  const std::optional<double> scale = row.number(1);
  const std::optional<double> offset = row.number(2);
  if (!scale || !offset || *scale == 0.0) return Error{"its scale and offset must be numbers, and the scale not 0"};
  return NumberInfo{.scale = *scale,
                    .offset = *offset,
                    .nodata = row.number(3),
                    .floats = row.text(0) == std::string("float"),
                    .unit = row.text(4).value_or(""),
                    .quantity = quantity_of(row.text(6).value_or(""))};
}

}  // namespace

Result<NumberInfo> read_coverage(SqliteReader& reader, const std::string& table, const std::string& where) {
  const auto refuse = [&](const std::string& why) {
    return Error{fmt::format("{}: the numbers of \"{}\" (gpkg_2d_gridded_coverage_ancillary): {}", where, table, why)};
  };
  // The unit may be absent, because early writers had no column for it.
  const char* kColumns = "datatype, scale, \"offset\", data_null, {}, grid_cell_encoding, quantity_definition";
  const auto select = [&](const char* unit) {
    return reader.prepare(
        fmt::format("SELECT {} FROM gpkg_2d_gridded_coverage_ancillary WHERE tile_matrix_set_name = ?1",
                    fmt::format(fmt::runtime(kColumns), unit)));
  };
  Result<SqliteQuery, SqlError> query = select("uom");
  if (!query) query = select("NULL");
  if (!query) return refuse(query.error().message);
  query->bind(1, table);
  const Result<bool, SqlError> row = query->step();
  if (!row) return refuse(row.error().message);
  if (!*row) return refuse("nothing is said of them");
  Result<NumberInfo> info = info_of(*query);
  if (!info) return refuse(info.error().message);
  return info;
}

}  // namespace terrella
