"""Where the parts of a sweep are made: here, by an executor, on a Dask cluster, or by Ray."""

from __future__ import annotations

import concurrent.futures
import importlib
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from . import _core

AHEAD = 2
"""Tasks handed over for each core of an engine, so that none of them waits for the next."""

Make = Callable[..., Any]
Submit = Callable[..., Any]


class Engine:
    """Hands tasks over, waits until some are done, and takes what came of them."""

    def __init__(self, make: Make, on: Any) -> None:
        kind = type(on).__module__.split(".")[0]
        self.submit: Submit
        self.wait: Callable[[set[Any]], tuple[Iterable[Any], Iterable[Any]]]
        self.result: Callable[[Any], Any] = lambda handle: handle.result()
        self.cancel: Callable[[Any], Any] = lambda handle: handle.cancel()
        self.cores: Callable[[], int]
        if kind == "distributed":
            wait = importlib.import_module("distributed").wait
            self.submit = lambda *task: on.submit(make, *task, pure=False)
            self.wait = lambda handles: wait(handles, return_when="FIRST_COMPLETED")
            self.cores = lambda: sum(on.nthreads().values())
        elif on == "ray":
            ray = importlib.import_module("ray")
            if not ray.is_initialized():
                ray.init()
            self.submit = ray.remote(make).remote
            self.wait = lambda handles: ray.wait(list(handles), num_returns=1)
            self.result, self.cancel = ray.get, ray.cancel
            self.cores = lambda: int(ray.cluster_resources().get("CPU", 1))
        elif isinstance(on, concurrent.futures.Executor):
            self.submit = lambda *task: on.submit(make, *task)
            self.wait = lambda handles: concurrent.futures.wait(
                handles, return_when=concurrent.futures.FIRST_COMPLETED
            )
            self.cores = lambda: getattr(on, "_max_workers", 1)
        else:
            what = 'a Dask client, an executor of concurrent.futures, "ray", or nothing for this process'
            raise TypeError(f"sweeps do not run on a {type(on).__name__}: give {what}")

    def results(self, tasks: Iterable[tuple[Any, ...]]) -> Iterator[Any]:
        """What comes of the tasks, as it comes."""
        waiting: set[Any] = set()
        tasks, more = iter(tasks), True
        try:
            while more or waiting:
                while more and len(waiting) < AHEAD * max(1, self.cores()):
                    task = next(tasks, None)
                    more = task is not None
                    if task is not None:
                        waiting.add(self.submit(*task))
                if waiting:
                    done, left = self.wait(waiting)
                    waiting = set(left)
                    yield from map(self.result, done)
        finally:
            for handle in waiting:
                self.cancel(handle)


def results(make: Make, tasks: Iterable[tuple[Any, ...]], on: Any) -> Iterator[Any]:
    """What comes of the tasks, in any order; ``on`` nothing, one after the other in this process."""
    if on is None:
        return (make(*task, True) for task in tasks)
    return _guarded(Engine(make, on), tasks)


def _guarded(engine: Engine, tasks: Iterable[tuple[Any, ...]]) -> Iterator[Any]:
    done = 0
    try:
        for result in engine.results(tasks):
            done += 1
            yield result
    except _core.SaltusError:
        raise
    except Exception as error:
        says = f"the engine gave up after {done} parts: {type(error).__name__}: {error}"
        raise _core.SaltusError(f"{says}; whole parts stay, and the same call goes on behind them") from error
