"""Measures what a user gets from `kinefront optimize` on the paper's study: the designs of `front.csv`, and the time of the command.

    python -m pip install -r benches/comparison/requirements.txt
    python benches/comparison/reported.py PROGRAM... [--evaluations 1000,3000,6000] [--seeds 11] [--from 1] [--threads 2]

For each program and number of evaluations: the hypervolume of `front.csv` as a percentage of that of the reference front
(`assets/reference_fronts/combined.csv`; `compare.py` describes it), also with the logarithm of the mass, as the median over the random
seeds and the worst one, and the median of the wall-clock times of the whole command, with its recording, and of its parts. The
programs take turns, so that the load of the machine cancels.
"""

import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

from compare import ALL, hypervolume, reference_front


def measure(program, evaluations, seed, threads):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "run"
        command = [program, "optimize", "paper", "--quiet", "--evaluations", evaluations, "--seed", seed]
        start = time.perf_counter()
        subprocess.run([*map(str, command), "--threads", str(threads), "--out", str(out)], check=True)
        seconds = time.perf_counter() - start
        with open(out / "front.csv", newline="") as file:
            front = [(float(row["mass_kg"]), float(row["workspace_radius_m"])) for row in csv.DictReader(file)]
        times = json.loads((out / "run.json").read_text())["times"]
    parts = [times[part] for part in ("search_s", "verification_s", "certification_s")]
    return [hypervolume(front), hypervolume(front, logarithmic=True), len(front), seconds, *parts]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--evaluations", default="1000,3000,6000")
    parser.add_argument("--seeds", type=int, default=11)
    parser.add_argument("--from", dest="first", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    reference = reference_front(ALL)
    whole = [hypervolume(reference), hypervolume(reference, logarithmic=True)]
    print("| program | evaluations | front.csv | log mass | designs | command | search | verification | proofs |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for evaluations in map(int, arguments.evaluations.split(",")):
        found = {program: [] for program in arguments.programs}
        for seed in range(arguments.first, arguments.first + arguments.seeds):
            for program in arguments.programs:
                found[program].append(measure(program, evaluations, seed, arguments.threads))
        for program, rows in found.items():
            columns = list(zip(*rows))
            shares = [[100.0 * value / of for value in column] for column, of in zip(columns, whole)]
            quality = [f"{statistics.median(share):.2f} ({min(share):.2f})" for share in shares]
            times = [f"{statistics.median(column):.2f} s" for column in columns[3:]]
            cells = [pathlib.Path(program).name, evaluations, *quality, round(statistics.median(columns[2])), *times]
            print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
