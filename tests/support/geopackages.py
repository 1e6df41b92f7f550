"""Makes valid and hostile GeoPackages with the standard library's SQLite."""

import math
import sqlite3

from pictures import png

TABLES = """
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (table_name TEXT PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT, description TEXT,
  last_change DATETIME, min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER);
CREATE TABLE gpkg_tile_matrix_set (table_name TEXT PRIMARY KEY, srs_id INTEGER NOT NULL, min_x DOUBLE NOT NULL,
  min_y DOUBLE NOT NULL, max_x DOUBLE NOT NULL, max_y DOUBLE NOT NULL);
CREATE TABLE gpkg_tile_matrix (table_name TEXT NOT NULL, zoom_level INTEGER NOT NULL, matrix_width INTEGER NOT NULL,
  matrix_height INTEGER NOT NULL, tile_width INTEGER NOT NULL, tile_height INTEGER NOT NULL,
  pixel_x_size DOUBLE NOT NULL, pixel_y_size DOUBLE NOT NULL, PRIMARY KEY (table_name, zoom_level));
CREATE TABLE tiles (id INTEGER PRIMARY KEY, zoom_level INTEGER NOT NULL, tile_column INTEGER NOT NULL,
  tile_row INTEGER NOT NULL, tile_data BLOB NOT NULL, UNIQUE (zoom_level, tile_column, tile_row));
INSERT INTO gpkg_spatial_ref_sys VALUES ('WGS 84', 4326, 'EPSG', 4326, 'undefined', NULL);
INSERT INTO gpkg_contents VALUES ('tiles', 'tiles', 'tiles', '', '2020-01-01T00:00:00Z', -180, -90, 180, 90, 4326);
INSERT INTO gpkg_tile_matrix_set VALUES ('tiles', 4326, -180, -90, 180, 90);
INSERT INTO gpkg_tile_matrix VALUES ('tiles', 0, 2, 1, 256, 256, 0.703125, 0.703125);
"""

# Faults of hostile or broken GeoPackages: name, and the SQL that spoils a good one.
SPOILT = {
    "no tile tables": "DELETE FROM gpkg_contents",
    "contents without matrix set": "DELETE FROM gpkg_tile_matrix_set",
    "matrix set without matrices": "DELETE FROM gpkg_tile_matrix",
    "contents dropped": "DROP TABLE gpkg_contents",
    "table dropped": "DROP TABLE tiles",
    "web mercator": "UPDATE gpkg_tile_matrix_set SET srs_id = 3857; UPDATE gpkg_contents SET srs_id = 3857;"
                    "INSERT INTO gpkg_spatial_ref_sys VALUES ('Web', 3857, 'EPSG', 3857, 'undefined', NULL)",
    "tiles of no width": "UPDATE gpkg_tile_matrix SET tile_width = 0",
    "tiles of negative height": "UPDATE gpkg_tile_matrix SET tile_height = -256",
    "vast tiles": "UPDATE gpkg_tile_matrix SET tile_width = 2147483647, tile_height = 2147483647",
    "pixels of no size": "UPDATE gpkg_tile_matrix SET pixel_x_size = 0",
    "infinite pixels": "UPDATE gpkg_tile_matrix SET pixel_x_size = 9e999",
    "level out of range": "UPDATE gpkg_tile_matrix SET zoom_level = 1000000",
    "negative level": "UPDATE gpkg_tile_matrix SET zoom_level = -3",
    "text for numbers": "UPDATE gpkg_tile_matrix SET matrix_width = 'many', pixel_x_size = 'small'",
    "matrix set inside out": "UPDATE gpkg_tile_matrix_set SET min_x = 180, max_x = -180",
    "table name is SQL": "UPDATE gpkg_contents SET table_name = 'x\"; DROP TABLE tiles; --'",
    "tiles without columns": "DROP TABLE tiles; CREATE TABLE tiles (content)",
}

# Tile tables that are views, and a row of them never comes: none matches, or each costs what it may.
ENDLESS = {
    "counting": "SELECT i AS id, 0 AS zoom_level, -1 - i AS tile_column, 0 AS tile_row, x'01' AS tile_data FROM n",
    "slow": "SELECT i AS id, 0 AS zoom_level, -length(hex(zeroblob(10000000 + i % 9))) AS tile_column, 0 AS tile_row,"
            " x'01' AS tile_data FROM n",
}


def write_good(path, blob=None):
    """Two tiles of level 0, a PNG each unless other bytes are given."""
    with sqlite3.connect(path) as base:
        base.executescript("PRAGMA application_id = 1196444487; PRAGMA user_version = 10300;" + TABLES)
        for column in (0, 1):
            base.execute("INSERT INTO tiles VALUES (NULL, 0, ?, 0, ?)", (column, png(256, 256) if blob is None else blob))
    base.close()


def write_spoilt(path, name):
    write_good(path)
    with sqlite3.connect(path) as base:
        base.executescript(SPOILT[name])
    base.close()


def write_endless(path, name):
    write_good(path)
    with sqlite3.connect(path) as base:
        base.executescript("DROP TABLE tiles; CREATE VIEW tiles AS WITH RECURSIVE n(i) AS "
                           "(SELECT 0 UNION ALL SELECT i + 1 FROM n) " + ENDLESS[name])
    base.close()


def nan_box(path):
    """Bounds that are not numbers; SQLite keeps NaN as NULL, which the table's own rule forbids: so drop the rule."""
    write_good(path)
    with sqlite3.connect(path) as base:
        base.executescript("DROP TABLE gpkg_tile_matrix_set;"
                           "CREATE TABLE gpkg_tile_matrix_set (table_name, srs_id, min_x, min_y, max_x, max_y)")
        base.execute("INSERT INTO gpkg_tile_matrix_set VALUES ('tiles', 4326, ?, ?, ?, ?)",
                     (math.nan, -math.inf, math.inf, math.nan))
    base.close()
