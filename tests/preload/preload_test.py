"""Shared parts of the tests of `terrella preload`."""

import json
import pathlib
import sqlite3
import tempfile

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


class PyramidTest(PreloadTest):
    """The tests of a class share a pyramid of LEVELS levels; each has an nginx of its own that serves it."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="terrella-preload-")
        cls.addClassCleanup(folder.cleanup)
        cls.pyramid = pathlib.Path(folder.name) / "tiles"
        servers.write_pyramid(cls.pyramid, cls.LEVELS)

    def setUp(self):
        super().setUp()
        self.server = self.enterContext(servers.nginx(self.pyramid))
