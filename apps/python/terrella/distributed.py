"""Cuts, preloads and films on a Dask cluster. apps/python/DISTRIBUTED.md tells operators how to run one.

    from distributed import Client
    from terrella.distributed import plan_cut, run
    run(Client("scheduler:8786"), plan_cut("/shared/planet.tif", output="/shared/planet.gpkg", parts=64))

A plan is a value: a few words, and for each task the keywords of a function of terrella. To make a plan reads and
writes nothing. run() gives the tasks to Dask, joins what they wrote, and leaves the bytes that one machine writes,
whatever the number of workers and whichever of them die.
"""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import functools
import os
import pathlib
import shutil
import time
import warnings
from collections.abc import Iterator, Mapping
from typing import Any

import terrella

try:
    from distributed import Client, as_completed
except ImportError as error:
    raise ImportError("terrella.distributed needs Dask: install the package python3-distributed") from error

__all__ = ["Plan", "Report", "plan_cut", "plan_film", "plan_preload", "run"]

_Path = str | os.PathLike[str]
_Remark = tuple[type[Warning], str]

_MOST_PARTS = 100_000  # as `cut` takes
_JOIN = "join"  # name of a lock
_CACHE_ENDINGS = "", "-wal", "-shm", "-journal"  # as SQLite names its files
_LEAST_RATE = 0.01  # requests per second, as `preload` takes


@dataclasses.dataclass(frozen=True)
class Plan:
    """Work on one output, in `parts` tasks that may run in any order, on any machine, and more than once.

    Plans of equal arguments are equal. A plan has the same size for any number of pixels.
    """

    command: str  # the function of terrella: "cut", "preload" or "film"
    output: str
    parts: int
    options: Mapping[str, Any]  # keywords that all tasks have

    def task(self, index: int) -> dict[str, Any]:
        """Keywords of the function for task `index`, 1 to `parts`."""
        output = self.part(index) if self.command == "preload" else self.output
        return {**self.options, "output": output, "shard": (index, self.parts)}

    def part(self, index: int) -> str:
        """The cache that a task of a preload fills."""
        return f"{self.work}/{index}-of-{self.parts}.gpkg"

    @property
    def work(self) -> str:
        """Folder beside the output for locks and parts, until all is done."""
        return self.output + ".work"


@dataclasses.dataclass(frozen=True)
class Report:
    """Values that the functions returned: in the tasks, by ascending index, and in the join."""

    parts: list[dict[str, Any]]
    joined: dict[str, Any] | None  # None for a film, which needs no join


def plan_cut(image: _Path | list[_Path], *, output: _Path, parts: int, **options: Any) -> Plan:
    """Cuts a picture, its parts, a folder or a list. `options` are those of terrella.cut.

    A part has whole bands (8 rows of tiles). Parts beyond the number of bands, rows / (8 * tile_size), do nothing.
    Raises ValueError for parts outside 1 to 100,000, relative paths, and options that the plan sets itself.
    """
    _refuse(options, "shard", "join", "keep_shards")
    for path in image if isinstance(image, list) else [image]:
        _check_place(path)
    return _plan("cut", output, parts, {"image": image, **options})


def plan_preload(source: _Path, *, output: _Path, parts: int, rate: float | None, **options: Any) -> Plan:
    """Preloads tiles of one server into a cache. `options` are those of terrella.preload.

    `rate` is the limit for the whole cluster, in requests per second with retries; None is no limit. Each part has
    rate / parts of it, so the limit holds for any number of workers. The full rate takes `parts` workers.

    A finished plan that is run again asks the server for every tile again, although the output has them. To extend an
    output, plan only what is new, for example the levels that it lacks.
    Raises ValueError for parts outside 1 to 100,000, relative paths, less than 0.01 requests per second for each part,
    outputs that cannot be extended (MBTiles, PMTiles), and options that make no sense for a part.
    """
    if os.fspath(output).endswith((".mbtiles", ".pmtiles")):
        raise ValueError(f"{os.fspath(output)}: a plan extends a cache; name one that ends in .gpkg, and merge it into "
                         "this file afterwards")
    _refuse(options, "shard", "dry_run", "release", "times", "missing", "stored", "cache_size")
    if rate is not None and not rate >= _LEAST_RATE * parts:
        raise ValueError(f"rate {rate}: each of {parts} parts needs {_LEAST_RATE} requests per second; plan fewer parts")
    _check_place(source)
    each = {} if rate is None else {"rate": rate / parts}
    return _plan("preload", output, parts, {"source": source, **options, **each})


def plan_film(tileset: _Path | None = None, *, flight: _Path, output: _Path, parts: int, **options: Any) -> Plan:
    """Renders the frames of a flight. `options` are those of terrella.film. Part I has every parts-th frame from I on.

    Raises ValueError for parts outside 1 to 100,000, relative paths, an output that is no pattern such as
    /shared/frames/%05d.png, and options that the plan sets itself.
    """
    _refuse(options, "shard", "force")
    if "%" not in os.fspath(output):
        raise ValueError(f"{os.fspath(output)}: tasks write frames; name them as /shared/frames/%05d.png")
    for path in (flight,) if tileset is None else (tileset, flight):
        _check_place(path)
    return _plan("film", output, parts, {"tileset": tileset, "flight": flight, **options})


def run(client: Client, plan: Plan, **submit: Any) -> Report:
    """Runs a plan on a cluster and waits for its end. A plan that was interrupted goes on when it is run again.

    `submit` are keywords of Dask's Client.submit, such as retries=2, resources={"GPU": 1} or priority=1. Paths must mean
    the same on all workers. Raises what a task raised: terrella.Error, ValueError, or distributed.KilledWorker for a
    task that more workers died of than Dask allows. Tasks that have not begun are cancelled then. Warnings of tasks are
    given here, each once. A preload that lacks tiles is joined and keeps its parts, so that the next run completes it.
    """
    remarks: dict[_Remark, None] = {}
    indices = range(1, plan.parts + 1)
    futures = client.map(functools.partial(_work, plan), indices, key=f"terrella-{plan.command}", pure=False, **submit)
    results = _gather(client, dict(zip((future.key for future in futures), indices)), futures, remarks)
    joined = None
    if plan.command != "film":
        joined = _call(client, _join, plan, remarks, submit)
    lacking = any(issubclass(category, terrella.IncompleteWarning) for category, _ in remarks)
    if not (lacking and plan.command == "preload"):
        _call(client, _clean, plan, remarks, submit)
    for category, message in remarks:
        warnings.warn(message, category, stacklevel=2)
    return Report(parts=[results[index] for index in indices], joined=joined)


def _plan(command: str, output: _Path, parts: int, options: dict[str, Any]) -> Plan:
    if not 1 <= parts <= _MOST_PARTS:
        raise ValueError(f"parts {parts}: it takes 1 to {_MOST_PARTS}")
    _check_path(output)
    return Plan(command=command, output=os.fspath(output).rstrip("/"), parts=parts, options=options)


def _check_path(path: _Path) -> None:
    if not os.path.isabs(path):
        raise ValueError(f"{os.fspath(path)}: each worker has its own current folder; give an absolute path")


def _check_place(place: _Path) -> None:
    """Accepts addresses, and paths as _check_path() does."""
    if "://" not in os.fspath(place):
        _check_path(place)


def _refuse(options: dict[str, Any], *names: str) -> None:
    for name in names:
        if options.get(name) not in (None, False):
            raise ValueError(f"{name}: a plan for a cluster does not take it")


def _gather(client: Client, index_of: dict[str, int], futures: list[Any],
            remarks: dict[_Remark, None]) -> dict[int, dict[str, Any]]:
    """Results of tasks by index, taken as soon as they are there."""
    results: dict[int, dict[str, Any]] = {}
    try:
        for future, (result, said) in as_completed(futures, with_results=True):
            future.release()  # else the death of a worker that has it would repeat the task
            results[index_of[future.key]] = result
            remarks.update(dict.fromkeys(said))
    except BaseException:
        client.cancel(futures)
        raise
    return results


def _call(client: Client, function: Any, plan: Plan, remarks: dict[_Remark, None], submit: dict[str, Any]) -> Any:
    result, said = client.submit(function, plan, pure=False, **submit).result()
    remarks.update(dict.fromkeys(said))
    return result


@contextlib.contextmanager
def _locked(plan: Plan, name: str) -> Iterator[str]:
    """Waits for a lock and gives its path. The owner of a lock may remove its file; those who wait then notice."""
    path = f"{plan.work}/{name}.lock"
    while True:
        os.makedirs(plan.work, exist_ok=True)
        try:
            lock = open(path, "w")
        except FileNotFoundError:  # the folder was removed again
            continue
        with lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if _is_at(path, lock.fileno()):
                yield path
                return
        # All plans of an output share the lock of the join. A part's lock is removed with the part.
        if name != _JOIN and not os.path.exists(path):
            raise terrella.Error(f"{plan.output}: another run of this plan has finished meanwhile")


def _is_at(path: str, descriptor: int) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(path))
    except FileNotFoundError:
        return False


@contextlib.contextmanager
def _alone(plan: Plan, name: str) -> Iterator[list[_Remark]]:
    """Waits until no other process does this part, as a worker may that the scheduler lost. Collects warnings."""
    said: list[_Remark] = []
    with _locked(plan, name), warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield said
        said.extend((warning.category, str(warning.message)) for warning in caught)


def _work(plan: Plan, index: int) -> tuple[dict[str, Any], list[_Remark]]:
    with _alone(plan, f"{index}-of-{plan.parts}") as said:
        if rate := plan.options.get("rate"):
            # A dead worker may have sent a whole burst just now: a quarter of a second's requests, at least one.
            time.sleep(max(0.25, 1.0 / rate))
        result = getattr(terrella, plan.command)(**plan.task(index))
    return result, said


def _join(plan: Plan) -> tuple[dict[str, Any], list[_Remark]]:
    with _alone(plan, _JOIN) as said:
        if plan.command == "cut":
            return terrella.cut(**plan.options, output=plan.output, join=True, keep_shards=True), said
        caches: list[_Path] = [plan.part(index) for index in range(1, plan.parts + 1)]
        # An earlier output is extended, as `preload` does.
        caches += [plan.output] if os.path.exists(plan.output) else []
        return terrella.merge(caches, output=plan.output), said


def _clean(plan: Plan) -> tuple[None, list[_Remark]]:
    """Removes what only an unfinished plan needs. Parts of other plans of the output stay."""
    output = pathlib.Path(plan.output)
    for index in range(1, plan.parts + 1):
        with _locked(plan, f"{index}-of-{plan.parts}") as lock:
            shutil.rmtree(output.with_name(f"{output.name}.shard-{index}-of-{plan.parts}"), ignore_errors=True)
            for ending in _CACHE_ENDINGS:
                pathlib.Path(plan.part(index) + ending).unlink(missing_ok=True)
            os.unlink(lock)
    with _locked(plan, _JOIN) as lock:
        os.unlink(lock)
    with contextlib.suppress(OSError):  # another plan works there
        os.rmdir(plan.work)
    return None, []
