"""Evaluations per second from Python, beside those of the program.

    python python/benches/evaluations.py PROGRAM

Both evaluate the same random designs of the paper's bounds, in turn, several times; the medians and their ratio are printed. The program
reads one design a line and evaluates on one core (`kinefront evaluate --stdin`), so that Python is measured on one core, too, and then
on all. The package computes every quantity, so that the program is given a study that names them all; beside it stands the paper's study,
which names few.
"""

import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import kinefront

BATCH, BATCHES, ROUNDS = 1000, 4, 5


def main() -> None:
    program = sys.argv[1]
    study = kinefront.Study.paper()
    random = np.random.default_rng(1)
    batches = []
    for _ in range(BATCHES):
        columns = {name: random.uniform(low, high, BATCH) for name, (low, high) in study.bounds.items()}
        batches.append({**columns, "architecture": random.choice(study.architectures, BATCH)})
    lines = "".join(f"{design}\n" for batch in batches for design in study.designs(batch))

    def is_quantity(name: str) -> bool:
        try:
            study.replace(f'quantities = ["{name}"]')
        except kinefront.StudyError:
            return False
        return True

    quantities = [name for name in study.evaluate(batches[0]).columns if is_quantity(name)]
    assert "transmission_min" in quantities
    full = pathlib.Path(tempfile.mkdtemp()) / "full.toml"
    full.write_text(study.replace(f"quantities = {quantities}").to_toml())

    def of_program(*more: object) -> float:
        since = time.perf_counter()
        subprocess.run([program, "evaluate", "--stdin", *more], input=lines.encode(), stdout=subprocess.DEVNULL, check=True)
        return BATCH * BATCHES / (time.perf_counter() - since)

    def of_python(threads: int | None) -> float:
        since = time.perf_counter()
        for batch in batches:
            study.evaluate(batch, threads=threads)
        return BATCH * BATCHES / (time.perf_counter() - since)

    rates = [(of_program("--study", full), of_program(), of_python(1), of_python(None)) for _ in range(ROUNDS)]
    names = ["program, all quantities", "program, the paper's study", "Python, one core", "Python, all cores"]
    medians = [statistics.median(rate) for rate in zip(*rates)]
    for name, rate in zip(names, medians):
        print(f"{name:26} {rate:8.0f} designs/s  {rate / medians[0]:.2f}")
    design = study.design("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056")
    poses = np.column_stack([random.uniform(-0.5, 0.5, (200_000, 2)), random.uniform(-0.2, 0.2, 200_000)])
    times = []
    for _ in range(ROUNDS):
        since = time.perf_counter()
        design.poses(poses)
        times.append(1e9 * (time.perf_counter() - since) / len(poses))
    print(f"poses with joints, K and margins, all cores: {statistics.median(times):.0f} ns each")


if __name__ == "__main__":
    main()
