"""Predicts cuts on a cluster from measured costs, and prints the table of apps/python/DISTRIBUTED.md. Run by hand."""

import dataclasses
import math
import pickle
import resource
import time

from terrella.distributed import plan_cut

TILE_PX, BAND_LEVELS = 256, 3
MOST_PARTS = 100_000
DAY_S = 86_400


@dataclasses.dataclass(frozen=True)
class Costs:
    """Costs measured on one core of a machine with two, shared with other work; the page says with which pictures."""

    decode_s: float = 9.3e-9  # per pixel, TIFF with deflate
    encode_s: float = 11.2e-9  # per pixel, JPEG, with the coarser levels of a band
    written_bytes: float = 0.31  # per pixel, tiles of all levels
    read_bytes: float = 1.0  # per pixel, assumed
    join_s: float = 1 / 168e6  # per byte of the output
    start_s: float = 0.02  # per task
    scheduler_s: float = 2.2e-3  # per task
    store_s: float = 1 / 5e9  # per byte, assumed: 5 GB/s for all workers together


def cut(pixels, workers, costs):
    """Seconds of each stage of a cut of a whole planet, and bytes that a task needs for a row of tiles."""
    rows = math.sqrt(pixels / 2)
    bands = math.ceil(rows / (TILE_PX << BAND_LEVELS))
    parts = min(bands, MOST_PARTS)
    task_s = costs.start_s + pixels / parts * (costs.decode_s + costs.encode_s)
    return {
        "parts": parts,
        "tasks": math.ceil(parts / workers) * task_s,
        "scheduler": parts * costs.scheduler_s,
        "store": pixels * (costs.read_bytes + costs.written_bytes) * costs.store_s,
        "join": pixels * costs.written_bytes * costs.join_s,
        "row_bytes": 2 * rows * TILE_PX * 4 * (2 - 0.5**BAND_LEVELS),
    }


def text_of(seconds):
    return f"{seconds:.1f} s" if seconds < 600 else f"{seconds / 3600:.1f} h" if seconds < DAY_S else f"{seconds / DAY_S:.1f} d"


def main():
    print("| pixels | workers | parts | tasks | scheduler | store | join | limit | memory of a worker |\n|---|" + "---|" * 8)
    for pixels in 1e12, 1e15:
        for workers in 1, 64, 4096:
            told = cut(pixels, workers, Costs())
            stages = {name: told[name] for name in ("tasks", "scheduler", "store", "join")}
            exponent = round(math.log10(pixels))
            print(f"| 10^{exponent} | {workers:,} | {told['parts']:,} |", " | ".join(map(text_of, stages.values())),
                  f"| {max(stages, key=stages.get)} | {told['row_bytes'] / 1e9:.1f} GB |")
    begun = time.monotonic()
    plan = plan_cut("/shared/planet", output="/shared/planet.gpkg", parts=cut(1e15, 1, Costs())["parts"])
    bytes_of_tasks = sum(len(pickle.dumps(plan.task(index))) for index in range(1, plan.parts + 1))
    print(f"plan of 10^15 pixels: {len(pickle.dumps(plan))} bytes, its {plan.parts:,} tasks {bytes_of_tasks / 1e6:.1f} MB, "
          f"{time.monotonic() - begun:.2f} s, {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB")


if __name__ == "__main__":
    main()
