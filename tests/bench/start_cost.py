"""Start of `terrella render` with the included Earth: seconds from the start of the process to its end, processor time,
and the parts that take it.

Each row is one way to start: with the shaders in Mesa's cache, with an empty cache, and unlit. Programs are run in turn,
so give a second one, for example of an earlier version, to compare. The trace needs `perf` (Debian: linux-perf).
Usage: start_cost.py TERRELLA [OTHER_TERRELLA] [--runs N] [--trace]
"""

import argparse
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile
import time

WAYS = {"warm": ([], False), "warm, --unlit": (["--unlit"], False), "empty shader cache": ([], True)}

# Parts of a start by the functions in which they lie: the first that a stack contains, in this order.
PARTS = {
    "picture file (PNG)": ("write_picture",),
    "tables of the air": ("AirTables", "make_sky_colors", "make_ground_colors"),
    "stars, city lights": ("load_sky_data",),
    "tiles: read and decode": ("TileScheduler",),
    "shaders: read, compile, link": ("build_program", "choose_shader_functions"),
    "shaders: machine code (LLVM)": ("llvm::", "LLVM"),
    "OpenGL context": ("HeadlessContext::create",),
    "texture slots, upload of tiles": ("TileTextures::",),
    "patches, meshes, plan": ("plan_frame", "PatchBuffers", "Globe::Impl::plan"),
    "drawing, main thread": ("GlobeRenderer::draw", "OffscreenTarget"),
    "opening the tile set": ("open_base",),
    "loading the program's libraries": ("_dl_start", "dl_main", "_dl_relocate"),
}


def run(program, folder, options, environment):
    """Wall and processor time in seconds."""
    begun = time.monotonic()
    process = subprocess.Popen([program, "render", "-o", str(folder / "earth.png"), *options], env=environment,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise RuntimeError(f"{program} render ended with {process.returncode}")
    return time.monotonic() - begun, usage.ru_utime + usage.ru_stime


def measure(programs, runs, folder):
    for way, (options, cold) in WAYS.items():
        times = {program: [] for program in programs}
        for k in range(-1, runs):
            for number, program in enumerate(programs):
                cache = folder / f"shaders-{number}"
                if cold:
                    shutil.rmtree(cache, ignore_errors=True)
                cache.mkdir(exist_ok=True)
                taken = run(program, folder, options, {**os.environ, "MESA_SHADER_CACHE_DIR": str(cache)})
                if k >= 0:
                    times[program].append(taken)
        for program, taken in times.items():
            wall, cpu = zip(*taken)
            print(f"{way:20} {program}: {statistics.median(wall):.3f} s (least {min(wall):.3f}), processor "
                  f"{statistics.median(cpu):.3f} s (least {min(cpu):.3f})", flush=True)


def trace(program, folder):
    cache = folder / "shaders-0"
    cache.mkdir(exist_ok=True)
    data = folder / "perf.data"
    environment = {**os.environ, "MESA_SHADER_CACHE_DIR": str(cache)}
    run(program, folder, [], environment)
    subprocess.run(["perf", "record", "-q", "-F", "2000", "-e", "cpu-clock", "--call-graph", "dwarf,32768", "-o", data, program,
                    "render", "-o", folder / "earth.png"], env=environment, check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    script = subprocess.run(["perf", "script", "-i", data, "--no-inline", "-F", "comm,ip,sym"], check=True,
                            capture_output=True, text=True).stdout
    counts = dict.fromkeys([*PARTS, "drawing, threads of the rasteriser", "the rest"], 0)
    stacks = [stack for stack in re.split(r"\n\s*\n", script) if stack.strip()]
    for stack in stacks:
        part = next((name for name, marks in PARTS.items() if any(mark in stack for mark in marks)), "the rest")
        if part == "the rest" and stack.lstrip().startswith("llvmpipe"):
            part = "drawing, threads of the rasteriser"
        counts[part] += 1
    print(f"{len(stacks) / 2:.0f} ms of processor time")
    for part, count in sorted(counts.items(), key=lambda item: -item[1]):
        print(f"  {part:36} {count / 2:6.0f} ms  {100 * count / len(stacks):5.1f} %")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--trace", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        measure(arguments.programs, arguments.runs, folder)
        if arguments.trace:
            trace(arguments.programs[0], folder)


if __name__ == "__main__":
    main()
