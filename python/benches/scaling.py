"""Time of designs and of searches on threads and on worker processes of Dask.

    python python/benches/scaling.py

The same designs and the same searches are performed on one thread, on all threads, and by one and more worker processes of one thread
each. Times are the least of several rounds; the ratio is to one thread.
"""

import os
import time
from collections.abc import Callable

import distributed
import numpy as np

from kinefront import Study, dask, sweeps

DESIGNS, SEARCHES, EVALUATIONS, ROUNDS = 20_000, 4, 600, 2


def least(task: Callable[[], object]) -> float:
    times = []
    for _ in range(ROUNDS):
        since = time.perf_counter()
        task()
        times.append(time.perf_counter() - since)
    return min(times)


def main() -> None:
    study = Study.paper()
    random = np.random.default_rng(1)
    designs = {name: random.uniform(low, high, DESIGNS) for name, (low, high) in study.bounds.items()}
    designs["architecture"] = random.choice(study.architectures, DESIGNS)
    seeds = range(1, SEARCHES + 1)
    cores = os.cpu_count() or 1

    def local(threads: int) -> tuple[float, float]:
        return (
            least(lambda: study.evaluate(designs, threads=threads)),
            least(lambda: sweeps.sweep(study, {"as given": ""}, seeds, evaluations=EVALUATIONS, threads=threads)),
        )

    def of_workers(count: int) -> tuple[float, float]:
        with (
            distributed.LocalCluster(n_workers=count, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
            distributed.Client(cluster) as client,
        ):
            return (
                least(lambda: dask.evaluate(study, designs, client)),
                least(lambda: dask.sweep(study, {"as given": ""}, seeds, client, evaluations=EVALUATIONS)),
            )

    cases = {"1 thread": local(1), f"{cores} threads": local(cores)}
    cases |= {f"{count} worker{'s' if count > 1 else ''} of Dask": of_workers(count) for count in sorted({1, cores})}
    whole = cases["1 thread"]
    print(f"| | {DESIGNS} designs | {SEARCHES} searches of {EVALUATIONS} evaluations |\n|---|---:|---:|")
    for name, times in cases.items():
        cells = (f"{seconds:.2f} s ({one / seconds:.2f})" for seconds, one in zip(times, whole))
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
