"""Predicts a cut on a cluster from measured costs, and prints a table: simulate.py

Run by hand; apps/python/DISTRIBUTED.md has the result. Time is that of tasks in rounds over the workers, of the
scheduler, of the store, and of the join, which is one task.
"""

import dataclasses
import math
import resource
import time

from terrella.distributed import plan_cut

TILE_PX, BAND_LEVELS = 256, 3


@dataclasses.dataclass(frozen=True)
class Costs:
    """Measured on 2 cores of 2.1 GHz with a JPEG-free TIFF; see the page."""

    decode_s: float = 0.0  # of a pixel
    encode_s: float = 0.0  # of a pixel, with the levels above it
    write_bytes: float = 0.0  # of a pixel, in tiles of all levels
    join_bytes_per_s: float = 0.0
    start_s: float = 0.0  # of a task: opens the picture
    scheduler_s: float = 0.0  # of a task
    store_bytes_per_s: float = 5e9  # assumed: all workers together


def cut(pixels, workers, costs):
    """Seconds of each stage for a picture of 2:1."""
    rows = math.sqrt(pixels / 2)
    bands = math.ceil(rows / (TILE_PX << BAND_LEVELS))
    rounds = math.ceil(bands / workers)
    task_s = costs.start_s + pixels / bands * (costs.decode_s + costs.encode_s)
    return {"bands": bands, "tasks": rounds * task_s, "scheduler": bands * costs.scheduler_s,
            "store": pixels * (3 + 2 * costs.write_bytes) / costs.store_bytes_per_s,
            "join": pixels * costs.write_bytes / costs.join_bytes_per_s,
            "strip_bytes": 2 * rows * TILE_PX * 4}
