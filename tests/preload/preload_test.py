"""Shared parts of the tests of `terrella preload`."""

import json
import sqlite3

import servers
from program import ProgramTest


class PreloadTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.root = self.folder / "tiles"
        self.cache = self.folder / "cache.gpkg"

    def preload(self, source, *options, code=0, **run):
        """Runs it, expects the exit code, and gives its summary and what it said."""
        done = self.run_program("preload", source, "-o", self.cache, "--json", *options, **run)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return (json.loads(done.stdout) if done.stdout else None), done.stderr

    def stored(self):
        """(z, x, y) to bytes of every tile in the cache."""
        base = sqlite3.connect(self.cache)
        self.addCleanup(base.close)
        rows = base.execute("SELECT zoom_level, tile_column, tile_row, tile_data FROM tiles").fetchall()
        return {(z, x, y): data for z, x, y, data in rows}

    def assert_sound(self):
        base = sqlite3.connect(self.cache)
        self.assertEqual(base.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
        base.close()

    def assert_stored_are_right(self):
        for place, data in self.stored().items():
            self.assertEqual(data, servers.tile_file(*place).read_bytes(), place)
