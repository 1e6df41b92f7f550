#!/usr/bin/env python3
"""Runs info, render, cut and preload over seeded mutations of every kind of container, under limits of time and memory.

Example:  tests/mutation/mutated_containers.py --program build/terrella
          tests/mutation/mutated_containers.py --program build/terrella --only pmtiles --count 100 --seed 7
          tests/mutation/mutated_containers.py --program build/terrella --first 1234 --count 1 --keep /tmp/mutant

A mutant passes if each command ends by itself with an exit code of CLI.md, within the limits, with a message for each code
that is not 0, and without control characters in what it prints. Mutant N of a seed is always the same. A server on
127.0.0.1 serves the mutants of servers; other hosts are out of reach. Exit code 0: all mutants passed; 1: some failed.
"""
import argparse
import collections
import concurrent.futures
import contextlib
import functools
import http.server
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

from container_seeds import ADDRESS, Maker
from mutations import mutate_bytes, mutate_database, mutate_text

CPU_S = 20  # a mutant takes 0.3 s; the limit holds on a busy machine too, since only computing counts
MEMORY_BYTES = 4 << 30  # address space, of which software OpenGL reserves 1 GB
FILE_BYTES = 256 << 20
HANG_S = 300  # for a command that waits and computes nothing
INTERNAL = re.compile(r"terminate called|Sanitizer|runtime error:|std::|what\(\):|Traceback|Assertion|bad_alloc", re.IGNORECASE)
CONTROL = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
# A mutant that describes a server may have 10^10 places of tiles, and each is a request.
SMALL_PLAN = dict.fromkeys(("description", "gdal_wms", "wmts"), ("--bbox", "0,0,0.01,0.01"))
TEXTS = (".json", ".xml", ".txt", ".geojson", ".gltf", ".pgw", ".prj", ".vrt", ".hdr", ".lbl",
         ".kml", ".gpx", ".csv")


@contextlib.contextmanager
def server_of(folder):
    """The address of a server of the files in a folder."""

    class Quiet(http.server.SimpleHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def log_message(self, *_):
            pass

    class Server(http.server.ThreadingHTTPServer):
        def handle_error(self, *_):
            pass

    with Server(("127.0.0.1", 0), functools.partial(Quiet, directory=str(folder))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_address[1]}"
        server.shutdown()


def limit():
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S + 5))
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_BYTES, FILE_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    # A sanitizer reserves terabytes of addresses and limits memory itself.
    if "ASAN_OPTIONS" not in os.environ:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))


class Suite:
    def __init__(self, program, root, seed, only):
        self.program, self.root, self.seed = program, root, seed
        maker = Maker(program, root)
        kinds = [kind for kind in Maker.KINDS if only in kind]
        self.seeds = [(kind, maker.seeds(kind)) for kind in kinds]
        if not kinds:
            sys.exit(f"{only}: no such kind; choose one of {', '.join(Maker.KINDS)}")

    def copy(self, seed, name, address):
        """A copy of a seed, and what the commands get."""
        folder = self.root / "mutants" / str(name)
        shutil.copytree(seed.folder, folder)
        where = f"{address}/{name}"
        for document in (path for path in folder.iterdir() if path.suffix in TEXTS):
            document.write_bytes(document.read_bytes().replace(ADDRESS.encode(), where.encode()))
        return folder, seed.target.replace(ADDRESS, where)

    def check_seeds(self, address):
        """Every seed is drawn; else its mutants would try nothing but the refusal."""
        for kind, seed in ((kind, seed) for kind, seeds in self.seeds for seed in seeds):
            folder, target = self.copy(seed, seed.folder.name, address)
            code, fault = self.run(self.commands(kind, seed, target, random.Random(0))["render"], folder)
            if code != 0 or fault:
                sys.exit(f"the seed {seed.folder.name} is not drawn without a fault: exit code {code} {fault}")

    def mutant(self, number, address):
        """Makes the mutant. Its kind, its seed, and what the commands get."""
        rng = random.Random(f"{self.seed}/{number}")
        kind, seeds = self.seeds[number % len(self.seeds)]
        seed = rng.choice(seeds)
        folder, target = self.copy(seed, number, address)
        name = rng.choice(seed.mutable)
        file = folder / name
        if file.suffix in (".gpkg", ".mbtiles") and rng.randrange(2):
            mutate_database(rng, file)
        elif file.suffix in TEXTS:
            file.write_bytes(mutate_text(rng, name, file.read_bytes()))
        else:
            file.write_bytes(mutate_bytes(rng, file.read_bytes()))
        return kind, seed, folder, target, rng

    @staticmethod
    def commands(kind, seed, target, rng):
        heights = seed.heights and rng.randrange(2) == 0
        drawn = ("--objects", target) if seed.objects else ("--elevation", target) if heights else (target,)
        light = () if rng.randrange(8) == 0 else ("--unlit",)
        return {"info": ("info", target, *(("--verify",) if rng.randrange(2) else ())),
                "render": ("render", *drawn, "-o", "shot.png", "--size", "64x64", "--timeout", "5", *light),
                "cut": ("cut", target, "-o", "cut.gpkg", "--tile-size", "64", "--jobs", "1", *(("--elevation",) if heights else ())),
                "preload": ("preload", target, "-o", "loaded.gpkg", "--levels", rng.choice(("0-0", "0-1")), "--retries", "0", "--jobs", "2",
                            *SMALL_PLAN.get(kind, ()))}

    def check(self, number, address):
        """Kind, {command: exit code} and the reasons why the mutant fails."""
        kind, seed, folder, target, rng = self.mutant(number, address)
        codes, faults = {}, []
        for name, words in self.commands(kind, seed, target, rng).items():
            codes[name], fault = self.run(words, folder)
            if fault:
                faults.append(f"mutant {number} ({kind}, {seed.folder.name}): terrella {' '.join(words)}: {fault}")
        if not faults:
            shutil.rmtree(folder, ignore_errors=True)
        return kind, codes, faults

    def run(self, words, folder):
        env = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        env |= {f"XDG_{name}_HOME": str(folder / "kept") for name in ("CACHE", "CONFIG", "STATE")}
        env |= {"MESA_SHADER_CACHE_DIR": str(self.root / "shaders"), "LP_NUM_THREADS": "1", "LIBGL_ALWAYS_SOFTWARE": "1",
                "no_proxy": "127.0.0.1", "http_proxy": "http://127.0.0.1:9", "https_proxy": "http://127.0.0.1:9"}
        try:
            done = subprocess.run([self.program, *words], cwd=folder, env=env, capture_output=True, timeout=HANG_S,
                                  preexec_fn=limit, restore_signals=False, stdin=subprocess.DEVNULL, check=False)
        except subprocess.TimeoutExpired:
            return None, f"does not end within {HANG_S} s"
        return done.returncode, judge(done, "--verify" in words)


def judge(done, verifies):
    """Reason why a command's end is wrong; empty if it is right. Faults that info --verify finds are its result."""
    said = done.stdout + done.stderr
    text = said.decode("utf-8", "replace")
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return f"computes for more than {CPU_S} s"
    if not 0 <= done.returncode <= 3:
        return f"exit code {done.returncode}: {text[-500:]!r}"
    if found := INTERNAL.search(text):
        return f"prints {found.group()!r}: {text[-800:]!r}"
    if found := CONTROL.search(text):
        return f"prints the control character {found.group()!r}: {text[:500]!r}"
    if done.returncode != 0 and not (said if verifies else done.stderr).strip():
        return f"exit code {done.returncode} without a message"
    return ""


def report(ends, wrong, seed):
    for kind, counts in ends.items():
        print(f"{kind:12} " + "   ".join(f"{name} {dict(sorted(count.items(), key=str))}" for name, count in counts.items()))
    print(f"{sum(sum(counts['info'].values()) for counts in ends.values())} mutants of seed {seed}: {wrong} failed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=os.environ.get("TERRELLA"), help="terrella (default: $TERRELLA)")
    parser.add_argument("--count", type=int, default=3000, help="number of mutants (default: 3000)")
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant (default: 0)")
    parser.add_argument("--seed", type=int, default=1, help="another seed makes other mutants (default: 1)")
    parser.add_argument("--only", default="", help="only kinds with this in their name: " + ", ".join(Maker.KINDS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="mutants at once (default: one a core)")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for seeds and failed mutants (default: one that goes)")
    arguments = parser.parse_args()
    if arguments.program is None:
        parser.error("--program is missing")
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # for the commands: a write beyond the limit fails
    ends, wrong = {}, 0
    with tempfile.TemporaryDirectory(prefix="terrella-mutants-") as temporary:
        root = arguments.keep or pathlib.Path(temporary)
        (root / "mutants").mkdir(parents=True)
        suite = Suite(arguments.program.resolve(), root.resolve(), arguments.seed, arguments.only)
        numbers = range(arguments.first, arguments.first + arguments.count)
        with server_of(suite.root / "mutants") as address, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            suite.check_seeds(address)
            for kind, codes, faults in pool.map(lambda number: suite.check(number, address), numbers):
                counts = ends.setdefault(kind, {})
                for name, code in codes.items():
                    counts.setdefault(name, collections.Counter())[code] += 1
                wrong += bool(faults)
                for fault in faults:
                    print(fault, flush=True)
    report(ends, wrong, arguments.seed)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
