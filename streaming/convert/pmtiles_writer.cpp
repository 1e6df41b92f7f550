#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "streaming/convert/part_file.h"
#include "streaming/convert/web_tiles.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/file_bytes.h"
#include "streaming/pmtiles/pmtiles_format.h"
#include "streaming/pmtiles/tile_number.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

/// Lists on the disk. `start` is an offset in the file of contents, `place` one in the section of tiles.
constexpr const char* kScratchSchema[] = {
    "CREATE TABLE contents (hash INTEGER PRIMARY KEY, start INTEGER, length INTEGER)",
    "CREATE TABLE tiles (number INTEGER PRIMARY KEY, start INTEGER, length INTEGER)",
    "CREATE TABLE placed (start INTEGER PRIMARY KEY, place INTEGER)",
    "CREATE TABLE runs (tile INTEGER PRIMARY KEY, place INTEGER, length INTEGER, run INTEGER, start INTEGER)", "BEGIN"};

/// The largest root directory beside the header.
constexpr std::size_t kMaxRootBytes = kPmtilesHeadBytes - kPmtilesHeaderBytes;
/// Entries of a leaf directory: at least these, and so many that the root lists at most kMostLeaves.
constexpr std::uint64_t kLeastLeafEntries = 4096;
constexpr std::uint64_t kMostLeaves = 3500;

struct Statements {
  SqliteStatement find_content, add_content, add_tile, find_place, add_place, add_run;

  static WriteResult<Statements> prepare(SqliteWriter& database) {
    std::vector<SqliteStatement> made;
    made.reserve(6);
    for (const char* sql :
         {"SELECT start, length FROM contents WHERE hash = ?1", "INSERT INTO contents VALUES (?1, ?2, ?3)",
          "INSERT INTO tiles VALUES (?1, ?2, ?3)", "SELECT place, start FROM placed WHERE start = ?1",
          "INSERT INTO placed VALUES (?1, ?2)", "INSERT INTO runs VALUES (?1, ?2, ?3, ?4, ?5)"}) {
      auto statement = database.prepare(sql);
      if (!statement) return statement.error();
      made.push_back(*std::move(statement));
    }
    return Statements{std::move(made[0]), std::move(made[1]), std::move(made[2]),
                      std::move(made[3]), std::move(made[4]), std::move(made[5])};
  }
};

std::int64_t signed_number(std::uint64_t number) { return static_cast<std::int64_t>(number); }

PmtilesTileType tile_type_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::jpeg:
      return PmtilesTileType::jpeg;
    case ImageFormat::png:
      return PmtilesTileType::png;
    case ImageFormat::webp:
      return PmtilesTileType::webp;
    case ImageFormat::unknown:
      break;
  }
  return PmtilesTileType::unknown;
}

/// Stores each content once, in the order of arrival, behind a gap for header and root directory, and lists the tiles
/// in a database. finish() fills the gap and appends metadata and leaf directories. If tiles did not come in the order
/// of their numbers, it copies the contents in that order before.
class PmtilesWriter : public TileWriter {
 public:
  explicit PmtilesWriter(const WriterSetup& setup)
      : setup_(setup),
        scratch_path_(setup.part.string() + ".scratch"),
        zoom_of_roots_(zoom_of_roots(setup.info.grid)),
        contents_(setup.part.string() + ".pmtiles", setup.output),
        sorted_(setup.part.string() + ".sorted", setup.output),
        leaves_(setup.part.string() + ".leaves", setup.output) {}
  ~PmtilesWriter() override {
    sql_.reset();
    scratch_.reset();
    remove_database(scratch_path_);
  }
  PmtilesWriter(const PmtilesWriter&) = delete;
  PmtilesWriter& operator=(const PmtilesWriter&) = delete;

  [[nodiscard]] Status open() {
    if (Status opened = open_with_gap(contents_); !opened) return opened;
    return written(setup_.output, make_scratch());
  }

  [[nodiscard]] Status put(const TileId& id, std::span<const std::byte> bytes) override {
    const TileId web{.level = id.level + zoom_of_roots_, .x = id.x, .y = id.y};
    zooms_.add(web.level);
    formats_.add(sniff_format(bytes));
    const auto start = store(bytes);
    if (!start) return start.error();
    ++header_.addressed_tiles;
    const std::uint64_t number = tile_number(web);
    in_order_ = in_order_ && number >= next_number_;
    next_number_ = number + 1;
    return run(sql_->add_tile, {signed_number(number), *start, std::ssize(bytes)});
  }

  [[nodiscard]] Status finish() override {
    if (zooms_.empty()) return no_tiles_to_write(setup_.output);
    if (Status placed = place_tiles(); !placed) return placed;
    const auto root = pack_directories();
    if (!root) return root.error();
    if (Status sorted = sort_contents(); !sorted) return sorted;
    PartFile& archive = in_order_ ? contents_ : sorted_;
    if (Status complete = complete_archive(archive, *root); !complete) return complete;
    if (Status synced = sync_to_disk(archive.path()); !synced) return synced;
    return take_name(archive.path(), setup_.output, setup_.may_replace);
  }

 private:
  [[nodiscard]] static Status open_with_gap(PartFile& file) {
    if (Status opened = file.open(); !opened) return opened;
    return file.append(std::vector<std::byte>(kPmtilesHeadBytes));
  }

  WriteStatus make_scratch() {
    auto scratch = SqliteWriter::make_private(scratch_path_);
    if (!scratch) return scratch.error();
    scratch_ = *std::move(scratch);
    for (const char* sql : kScratchSchema) {
      if (WriteStatus done = scratch_->run(sql); !done) return done;
    }
    auto sql = Statements::prepare(*scratch_);
    if (!sql) return sql.error();
    sql_ = *std::move(sql);
    return Done{};
  }

  [[nodiscard]] Status run(SqliteStatement& statement, std::initializer_list<std::int64_t> values) {
    int index = 0;
    for (const std::int64_t value : values) statement.bind(++index, value);
    return written(setup_.output, statement.run());
  }

  /// The first row for a key, as two numbers; none if there is no row.
  [[nodiscard]] Result<std::optional<std::pair<std::int64_t, std::int64_t>>> find(SqliteStatement& statement,
                                                                                  std::int64_t key) {
    statement.bind(1, key);
    const WriteResult<bool> row = statement.step();
    if (!row) return cannot_write(setup_.output, row.error());
    std::optional<std::pair<std::int64_t, std::int64_t>> found;
    if (*row) found = std::pair(statement.integer(0), statement.integer(1));
    statement.reset();
    return found;
  }

  /// Returns the start of the content. Contents with equal hashes are compared.
  [[nodiscard]] Result<std::int64_t> store(std::span<const std::byte> bytes) {
    const std::int64_t hash = signed_number(std::hash<std::string_view>()(as_text(bytes)));
    const auto found = find(sql_->find_content, hash);
    if (!found) return found.error();
    if (found->has_value() && (*found)->second == std::ssize(bytes)) {
      const std::int64_t start = (*found)->first;
      const auto stored = contents_.read({.offset = static_cast<std::uint64_t>(start), .length = bytes.size()});
      if (!stored) return stored.error();
      if (std::ranges::equal(*stored, bytes)) return start;
    }
    const std::int64_t start = signed_number(contents_.size());
    if (Status appended = contents_.append(bytes); !appended) return appended.error();
    ++header_.tile_contents;
    header_.tiles.length += bytes.size();
    if (found->has_value()) return start;
    if (Status added = run(sql_->add_content, {hash, start, std::ssize(bytes)}); !added) return added.error();
    return start;
  }

  /// Calls `call` with each row of a query until it fails.
  template <class Call>
  [[nodiscard]] Status for_each_row(const char* sql, const Call& call) {
    auto query = scratch_->prepare(sql);
    if (!query) return cannot_write(setup_.output, query.error());
    for (;;) {
      const WriteResult<bool> more = query->step();
      if (!more) return cannot_write(setup_.output, more.error());
      if (!*more) return Done{};
      if (Status called = call(*query); !called) return called;
    }
  }

  /// Returns the place of a content in the archive. Contents that are not in order get the next free place.
  [[nodiscard]] Result<std::int64_t> place_of(std::int64_t start, std::int64_t length) {
    if (in_order_) return start - signed_number(kPmtilesHeadBytes);
    const auto found = find(sql_->find_place, start);
    if (!found) return found.error();
    if (found->has_value()) return (*found)->first;
    const std::int64_t place = std::exchange(free_place_, free_place_ + length);
    if (Status added = run(sql_->add_place, {start, place}); !added) return added.error();
    return place;
  }

  /// Joins tiles that follow each other with the same content to runs, in the order of tile numbers.
  [[nodiscard]] Status place_tiles() {
    std::optional<PmtilesEntry> entry;
    std::int64_t entry_start = 0;
    const auto end_entry = [&]() -> Status {
      if (!entry) return Done{};
      ++header_.tile_entries;
      return run(sql_->add_run,
                 {signed_number(entry->tile), signed_number(entry->offset), entry->length, entry->run, entry_start});
    };
    const Status placed = for_each_row("SELECT number, start, length FROM tiles ORDER BY number",
                                       [&](const SqliteStatement& row) -> Status {
                                         const auto number = static_cast<std::uint64_t>(row.integer(0));
                                         const std::int64_t start = row.integer(1), length = row.integer(2);
                                         if (entry && entry->tile + entry->run == number && entry_start == start) {
                                           ++entry->run;
                                           return Done{};
                                         }
                                         if (Status ended = end_entry(); !ended) return ended;
                                         const auto place = place_of(start, length);
                                         if (!place) return place.error();
                                         entry_start = start;
                                         entry = PmtilesEntry{.tile = number,
                                                              .offset = static_cast<std::uint64_t>(*place),
                                                              .length = static_cast<std::uint32_t>(length),
                                                              .run = 1};
                                         return Done{};
                                       });
    return placed ? end_entry() : placed;
  }

  /// Returns the packed root directory. Writes leaf directories if the root would be too long without.
  [[nodiscard]] Result<std::vector<std::byte>> pack_directories() {
    if (header_.tile_entries <= kPmtilesHeadBytes) {
      auto root = pack_leaf_directories(0);
      if (!root || root->size() <= kMaxRootBytes) return root;
    }
    std::uint64_t leaf_entries = std::max(kLeastLeafEntries, header_.tile_entries / kMostLeaves);
    for (;; leaf_entries += leaf_entries / 4) {
      auto root = pack_leaf_directories(leaf_entries);
      if (!root || root->size() <= kMaxRootBytes) return root;
    }
  }

  /// Writes leaf directories of so many entries, for 0 none. Returns the packed root directory.
  [[nodiscard]] Result<std::vector<std::byte>> pack_leaf_directories(std::uint64_t leaf_entries) {
    if (Status opened = leaves_.open(); !opened) return opened.error();
    PmtilesDirectory root, leaf;
    const auto end_leaf = [&]() -> Status {
      if (leaf.empty()) return Done{};
      const auto packed = pack(pmtiles_directory_bytes(leaf));
      if (!packed) return packed.error();
      root.push_back({.tile = leaf.front().tile,
                      .offset = leaves_.size(),
                      .length = static_cast<std::uint32_t>(packed->size()),
                      .run = 0});
      leaf.clear();
      return leaves_.append(*packed);
    };
    Status listed = for_each_row("SELECT tile, place, length, run FROM runs ORDER BY tile",
                                 [&](const SqliteStatement& row) -> Status {
                                   PmtilesDirectory& directory = leaf_entries == 0 ? root : leaf;
                                   directory.push_back({.tile = static_cast<std::uint64_t>(row.integer(0)),
                                                        .offset = static_cast<std::uint64_t>(row.integer(1)),
                                                        .length = static_cast<std::uint32_t>(row.integer(2)),
                                                        .run = static_cast<std::uint32_t>(row.integer(3))});
                                   return leaf_entries > 0 && leaf.size() == leaf_entries ? end_leaf() : Status(Done{});
                                 });
    if (listed) listed = end_leaf();
    if (!listed) return listed.error();
    return pack(pmtiles_directory_bytes(root));
  }

  [[nodiscard]] std::string metadata() const {
    const TileSetInfo& info = setup_.info;
    nlohmann::ordered_json object{{"name", info.name.empty() ? setup_.output.stem().string() : info.name},
                                  {"attribution", info.attribution},
                                  {"type", layer_type(formats_.common(info.format))},
                                  {kCutKeyField, setup_.mark}};
    if (!info.body.empty()) object["body"] = info.body;
    return object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }

  /// Appends metadata and leaf directories, and writes header and root directory into the gap.
  [[nodiscard]] Status complete_archive(PartFile& archive, const std::vector<std::byte>& root) {
    const std::string said = metadata();
    const auto packed = pack(std::as_bytes(std::span(said)));
    if (!packed) return packed.error();
    header_.root = {.offset = kPmtilesHeaderBytes, .length = root.size()};
    header_.tiles.offset = kPmtilesHeadBytes;
    header_.metadata = {.offset = archive.size(), .length = packed->size()};
    header_.leaves = {.offset = archive.size() + packed->size(), .length = leaves_.size()};
    header_.directory_compression = PmtilesCompression::gzip;
    header_.tile_compression = PmtilesCompression::none;
    header_.min_level = zooms_.least;
    header_.max_level = zooms_.most;
    header_.bounds = web_bounds(setup_.info.grid);
    header_.tile_type = tile_type_of(formats_.common(setup_.info.format));
    header_.clustered = true;
    if (Status appended = archive.append(*packed); !appended) return appended;
    if (Status appended = archive.append(leaves_, {.offset = 0, .length = leaves_.size()}); !appended) return appended;
    const auto head = pmtiles_header_bytes(header_);
    if (Status put = archive.write_at(0, head); !put) return put;
    return archive.write_at(kPmtilesHeaderBytes, root);
  }

  /// Copies each content at its first run, if they are not in order. Contents that arrived one after the other are one
  /// copy.
  [[nodiscard]] Status sort_contents() {
    if (in_order_) return Done{};
    if (Status opened = open_with_gap(sorted_); !opened) return opened;
    ByteRange next;
    std::int64_t place = 0;
    const Status listed =
        for_each_row("SELECT place, length, start FROM runs ORDER BY tile", [&](const SqliteStatement& row) -> Status {
          if (row.integer(0) < place) return Done{};
          const auto length = static_cast<std::uint64_t>(row.integer(1));
          const auto start = static_cast<std::uint64_t>(row.integer(2));
          place += row.integer(1);
          if (next.offset + next.length == start) {
            next.length += length;
            return Done{};
          }
          return sorted_.append(contents_, std::exchange(next, ByteRange{.offset = start, .length = length}));
        });
    return listed ? sorted_.append(contents_, next) : listed;
  }

  const WriterSetup setup_;
  const std::filesystem::path scratch_path_;
  const int zoom_of_roots_;
  ZoomRange zooms_;
  TileFormats formats_;
  PmtilesHeader header_;
  PartFile contents_, sorted_, leaves_;
  bool in_order_ = true;           ///< tile numbers have ascended so far
  std::uint64_t next_number_ = 0;  ///< the smallest that goes on in order
  std::int64_t free_place_ = 0;
  std::optional<SqliteWriter> scratch_;
  std::optional<Statements> sql_;
};

}  // namespace

Result<std::unique_ptr<TileWriter>> make_pmtiles_writer(const WriterSetup& setup) {
  auto writer = std::make_unique<PmtilesWriter>(setup);
  if (Status opened = writer->open(); !opened) return opened.error();
  return std::unique_ptr<TileWriter>(std::move(writer));
}

}  // namespace terrella
