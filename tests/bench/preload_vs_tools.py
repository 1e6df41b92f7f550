#!/usr/bin/env python3
"""Times `terrella preload` against curl, wget2, aria2c and mapproxy-seed: the same tiles from one nginx on loopback.

  tests/bench/preload_vs_tools.py build/terrella

Prints a Markdown table of medians. Missing tools are named and skipped; the packages are `curl`, `wget2`, `aria2` and
`mapproxy`. TMPDIR holds the tiles and the tools' outputs; /dev/shm excludes the disk from the measurement.
curl, wget2 and aria2c write plain files; terrella and mapproxy-seed write a GeoPackage. Latency is added with `tc netem`
if permitted, else by a small proxy in front of nginx that delays each read; the output names the method.
"""

import argparse
import contextlib
import json
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
NGINX = HERE.parent / "http/nginx.py"
LEVELS = 8  # levels of the western hemisphere: 21,845 tiles
JOBS = 16
SLOW = ("aria2c", "mapproxy-seed")  # once is enough to tell ten times the time from others


def write_pyramid(root, picture):
    """JPEG tiles of about 11 kB, no two alike: padded with random bytes in a comment."""
    base = picture.read_bytes()
    source = random.Random(1)
    places = []
    for z in range(LEVELS):
        for x in range(1 << z):
            (root / str(z) / str(x)).mkdir(parents=True)
            for y in range(1 << z):
                length = max(16, int(source.gauss(11000, 2500)) - len(base))
                comment = b"\xff\xfe" + (length + 2).to_bytes(2, "big") + source.randbytes(length)
                (root / str(z) / str(x) / f"{y}.jpg").write_bytes(base[:2] + comment + base[2:])
                places.append((z, x, y))
    return places


@contextlib.contextmanager
def nginx(root):
    process = subprocess.Popen([sys.executable, "-B", NGINX, root, "--no-log"], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    try:
        yield json.loads(process.stdout.readline())
    finally:
        process.stdin.close()
        process.wait()


def netem(milliseconds):
    """Half of the latency each way on the loopback device; False if it is not permitted."""
    subprocess.run(["tc", "qdisc", "del", "dev", "lo", "root"], capture_output=True, check=False)
    if milliseconds == 0:
        return True
    done = subprocess.run(["tc", "qdisc", "add", "dev", "lo", "root", "netem", "delay", f"{milliseconds / 2}ms", "limit",
                           "100000"], capture_output=True, check=False)
    return done.returncode == 0


PROXY = r"""
import asyncio, sys
port, delay = int(sys.argv[1]), float(sys.argv[2]) / 2000
async def pump(reader, writer):
    loop = asyncio.get_running_loop()
    held = asyncio.Queue(1024)
    async def late():
        while (item := await held.get()) is not None:
            due, data = item
            await asyncio.sleep(max(0.0, due - loop.time()))
            writer.write(data)
            await writer.drain()
        writer.close()
    task = asyncio.create_task(late())
    try:
        while data := await reader.read(262144):
            await held.put((loop.time() + delay, data))
    except OSError:
        pass
    await held.put(None)
    await asyncio.gather(task, return_exceptions=True)
async def serve(reader, writer):
    there_reader, there_writer = await asyncio.open_connection("127.0.0.1", port)
    await asyncio.gather(pump(reader, there_writer), pump(there_reader, writer), return_exceptions=True)
async def main():
    server = await asyncio.start_server(serve, "127.0.0.1", 0, limit=1 << 20)
    print(server.sockets[0].getsockname()[1], flush=True)
    await server.serve_forever()
asyncio.run(main())
"""


@contextlib.contextmanager
def delaying_proxy(port, milliseconds):
    process = subprocess.Popen([sys.executable, "-c", PROXY, str(port), str(milliseconds)], stdout=subprocess.PIPE,
                               text=True)
    try:
        yield int(process.stdout.readline())
    finally:
        process.terminate()
        process.wait()


def mapproxy_files(work, address, tls):
    (work / "mapproxy.yaml").write_text(f"""
sources:
  tiles: {{type: tile, url: '{address}/%(z)s/%(x)s/%(y)s.jpg', grid: geodetic, http: {{ssl_no_cert_checks: {str(tls).lower()}}}}}
grids:
  geodetic: {{srs: 'EPSG:4326', bbox: [-180, -90, 180, 90], res_factor: 2, num_levels: {LEVELS}, min_res: 0.703125,
             tile_size: [256, 256], origin: nw}}
caches:
  cache:
    sources: [tiles]
    grids: [geodetic]
    format: image/jpeg
    request_format: image/jpeg
    disable_storage: false
    cache: {{type: geopackage, filename: {work}/mapproxy.gpkg, table_name: tiles}}
globals: {{cache: {{lock_dir: {work}/locks, base_dir: {work}/base}}}}
""")
    (work / "seed.yaml").write_text(f"seeds: {{all: {{caches: [cache], coverages: [west], levels: {{from: 0, to: "
                                    f"{LEVELS - 1}}}}}}}\ncoverages: {{west: {{bbox: [-179.999, -89.999, -0.001, 89.999], "
                                    "srs: 'EPSG:4326'}}\n")


def commands(program, address, work, http2, ca_file, places):
    """Tool to command line; each writes under `work`."""
    urls = [f"{address}/{z}/{x}/{y}.jpg" for z, x, y in places]
    with (work / "curl.txt").open("w") as lines:
        for (z, x, y), url in zip(places, urls):
            lines.write(f'url = "{url}"\noutput = "{work}/curl/{z}/{x}/{y}.jpg"\n')
    (work / "urls.txt").write_text("\n".join(urls) + "\n")
    with (work / "aria2.txt").open("w") as lines:
        for (z, x, y), url in zip(places, urls):
            lines.write(f"{url}\n out={z}/{x}/{y}.jpg\n")
    mapproxy_files(work, address, http2)
    trust = ["--ca-file", ca_file]
    return {
        "terrella": [program, "preload", f"{address}/{{z}}/{{x}}/{{y}}.jpg", "--levels", f"0-{LEVELS - 1}",
                     "--bbox=-180,-90,0,90", "-o", work / "terrella.gpkg", "--jobs", JOBS, *trust],
        "curl": ["curl", "-s", "--parallel", "--parallel-max", JOBS, "--create-dirs", "--cacert", ca_file,
                 "--http2" if http2 else "--http1.1", "-K", work / "curl.txt"],
        "wget2": ["wget2", "-q", "-x", "-P", work / "wget2", "--max-threads", JOBS, f"--ca-certificate={ca_file}",
                  "--http2" if http2 else "--no-http2", "-i", work / "urls.txt"],
        "aria2c": ["aria2c", "-q", "-j16", "--dir", work / "aria2", f"--ca-certificate={ca_file}",
                   "--console-log-level=error", "--file-allocation=none", "-i", work / "aria2.txt"],
        "mapproxy-seed": ["mapproxy-seed", "-q", "-f", work / "mapproxy.yaml", "-s", work / "seed.yaml", "-c", 4],
    }


def clean(work):
    for path in work.iterdir():
        if path.is_dir():
            shutil.rmtree(path)
        elif ".gpkg" in path.name:
            path.unlink()


def timed(command, work):
    """Seconds on the clock, processor seconds."""
    clean(work)
    subprocess.run(["sync"], check=False)
    start = time.monotonic()
    process = subprocess.Popen(list(map(str, command)), cwd=work, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    told = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    wall_s = time.monotonic() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{command[0]} ended with {process.returncode}\n{told.decode(errors='replace')}")
    return wall_s, used.ru_utime + used.ru_stime


def measure(options, tools, server, latency_ms, http2, work, places):
    with contextlib.ExitStack() as stack:
        port = server["tls_port" if http2 else "port"]
        how = ""
        if latency_ms:
            how = "tc netem"
            if not netem(latency_ms):
                how = "delaying proxy"
                port = stack.enter_context(delaying_proxy(port, latency_ms))
        stack.callback(netem, 0)
        address = f"https://localhost:{port}" if http2 else f"http://127.0.0.1:{port}"
        lines = commands(options.terrella, address, work, http2, server["ca_file"], places)
        # Four processes that wait for each answer: with latency mapproxy-seed takes minutes, and tells nothing new.
        results = {tool: [] for tool in tools if not (tool == "mapproxy-seed" and latency_ms)}
        for run in range(options.runs):
            for tool in results:
                if tool in SLOW and run > 0:
                    continue
                results[tool].append(timed(lines[tool], work))
                wall_s, cpu_s = results[tool][-1]
                print(f"{'HTTP/2' if http2 else 'HTTP/1.1'} {latency_ms} ms {tool:14} {wall_s:6.2f} s  cpu {cpu_s:6.2f} s",
                      file=sys.stderr, flush=True)
        return how, {tool: (statistics.median(w for w, _ in all_runs), statistics.median(c for _, c in all_runs))
                     for tool, all_runs in results.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("terrella")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--tools", default="curl,wget2,aria2c,mapproxy-seed")
    parser.add_argument("--cases", default="1-0,1-20,2-0,2-20", help="HTTP version and latency in ms")
    options = parser.parse_args()
    options.terrella = pathlib.Path(options.terrella).resolve()
    tools = ["terrella"] + [tool for tool in options.tools.split(",") if shutil.which(tool)]
    absent = [tool for tool in options.tools.split(",") if tool and not shutil.which(tool)]
    with tempfile.TemporaryDirectory(prefix="terrella-bench-") as name:
        root, work = pathlib.Path(name) / "tiles", pathlib.Path(name) / "work"
        work.mkdir()
        places = write_pyramid(root, sorted((HERE.parent / "fixtures/natural_earth_ii").glob("2/*/*.jpg"),
                                            key=lambda path: path.stat().st_size)[0])
        rows, hows = {tool: [] for tool in tools}, set()
        cases = [tuple(map(int, case.split("-"))) for case in options.cases.split(",")]
        with nginx(root) as server:
            for version, latency_ms in cases:
                how, results = measure(options, tools, server, latency_ms, version == 2, work, places)
                hows.add(how)
                ours = results["terrella"][0]
                for tool in tools:
                    if tool not in results:
                        rows[tool].append("–")
                        continue
                    wall_s, cpu_s = results[tool]
                    rows[tool].append(f"{wall_s:.2f} s, {cpu_s / len(places) * 1e6:.0f} µs, {wall_s / ours:.2f}")
    heads = [f"{'HTTP/2 (TLS)' if version == 2 else 'HTTP/1.1'}, {latency_ms} ms" for version, latency_ms in cases]
    print(f"{len(places)} tiles of 11 kB, {JOBS} connections; wall time, processor time a tile, rate of terrella over "
          f"the tool's. Latency by {', '.join(filter(None, sorted(hows))) or 'nothing'}."
          + (f" Not installed: {', '.join(absent)}." if absent else ""))
    print(f"\n| | {' | '.join(heads)} |\n|---|{'---|' * len(heads)}")
    for tool in tools:
        print(f"| {tool} | {' | '.join(rows[tool])} |")


if __name__ == "__main__":
    main()
