"""Runs the program under test and checks its output."""

import functools
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["TERRELLA"]
SOURCE = pathlib.Path(os.environ["TERRELLA_SOURCE"])
BLUE_MARBLE = SOURCE / "data/earth/blue_marble_4096x2048.jpg"
NATURAL_EARTH = SOURCE / "tests/fixtures/natural_earth_ii"

DONE, FAILED, WRONG_USAGE, DONE_IN_PART = 0, 1, 2, 3

# A hostile input must end in a message, and soon; generous for a sanitizer build on a busy machine.
TIME_LIMIT_S = 60


class ProgramTest(unittest.TestCase):
    """Each test has a folder of its own as working folder, home and cache."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="terrella-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_program(self, *arguments, file_size_limit=None, environment=None, time_limit_s=TIME_LIMIT_S):
        env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        env |= {"XDG_CACHE_HOME": str(self.folder / "cache"), **(environment or {})}
        return subprocess.run(
            [PROGRAM, *map(str, arguments)], cwd=self.folder, env=env, capture_output=True, text=True,
            errors="replace", timeout=time_limit_s, preexec_fn=_limiter(file_size_limit), restore_signals=False)

    def assert_fails(self, code, *arguments, says, **options):
        """The program ends with `code`, and its message holds every text of `says`, as a person would look for them."""
        done = self.run_program(*arguments, **options)
        told = f"\n$ terrella {' '.join(map(str, arguments))}\nexit {done.returncode}\n{done.stdout}{done.stderr}"
        self.assertEqual(done.returncode, code, told)
        for text in says:
            self.assertIn(text, done.stderr, told)
        for internal in ("terminate called", "Sanitizer", "std::", "what():"):
            self.assertNotIn(internal, done.stderr, told)
        return done

    def assert_done(self, *arguments, **options):
        done = self.run_program(*arguments, **options)
        self.assertEqual(done.returncode, DONE, f"{arguments}\n{done.stdout}{done.stderr}")
        return done

    def assert_nothing_but(self, *names):
        """Nothing else was left in the working folder: no half-written output, no temporary file."""
        self.assertEqual(sorted(p.name for p in self.folder.iterdir() if p.name != "cache"), sorted(names))

    def write(self, name, data):
        path = self.folder / name
        path.write_bytes(data)
        return path


def _limiter(file_size_limit):
    """A full disk without one: no file may grow over the limit. SIGXFSZ, which Python ignores, is as a shell leaves it."""
    if file_size_limit is None:
        return None

    def limit():
        import resource
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_FSIZE, (file_size_limit, file_size_limit))
    return limit


@functools.cache
def subcommands():
    """The subcommands that the program offers, from its help."""
    text = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
    return re.findall(r"^  (\w+) ", text[text.index("Subcommands:"):].split("\n\n")[0], re.MULTILINE)
