"""What a row of a sweep takes: in this process, and on workers of Dask, for rows of 10 us and more."""

import os
import statistics
import tempfile
import time

import distributed

import saltus

VARY = {"restitution": "0.5:0.95:400", "ball.height": "1m:10m:500"}
SCENES = {
    "a ball": {"restitution": 0.8, "ball": {"height": "1 m"}},
    "a ball with drag": {"restitution": 0.8, "drag": {"per_length": 0.1}, "ball": {"height": "1 m"}},
}


def measured(scene, workers=list, **how):
    """Microseconds of the processors a row, in all processes, and of the clock: the median of five."""
    all = []
    for _ in range(5):
        with tempfile.TemporaryDirectory() as folder:
            start, used = time.perf_counter(), time.process_time() + sum(workers())
            rows = saltus.sweep(scene, vary=VARY, into=folder, most_jumps=20, progress=False, **how)
            used = time.process_time() + sum(workers()) - used
            all.append((1e6 * used / rows.runs, 1e6 * (time.perf_counter() - start) / rows.runs))
    return [statistics.median(values) for values in zip(*all)]


def main():
    cores = os.cpu_count()
    with (
        distributed.LocalCluster(n_workers=cores, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        for name, scene in SCENES.items():
            here, here_by_clock = measured(scene)
            there, there_by_clock = measured(scene, lambda: client.run(time.process_time).values(), on=client)
            print(f"{name:18s} processors: {here:5.1f} us a row here, {there:5.1f} on {cores} workers: {here / there:.0%}")
            print(f"{'':18s} clock:      {here_by_clock:5.1f}               {there_by_clock:5.1f}")


if __name__ == "__main__":
    main()
