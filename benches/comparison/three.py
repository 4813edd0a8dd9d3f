"""Compares Kinefront's optimizers with those of pymoo on three objectives: on a study of mass, workspace radius and footprint, and
on DTLZ2, DTLZ5, DTLZ7 and a welded beam.

    python -m pip install -r benches/comparison/requirements.txt
    cargo build --release --no-default-features
    cargo build --release -p kinefront-optimize --example three_objectives
    python benches/comparison/three.py target/release/kinefront target/release/examples/three_objectives OUT \
        [--seeds 3] [--problems study,dtlz2] [--evaluations 6000,30000]

The quality of a run is the hypervolume of the non-dominated candidates among all that it evaluated, whatever its population
keeps; moocore computes that of pymoo's candidates. The table states the median over the seeds. A run that is already in OUT is
not repeated.
"""

import argparse
import csv
import json
import multiprocessing
import pathlib
import statistics
import subprocess
import tempfile

import moocore
import numpy as np

from compare import LOWER, UPPER, Evaluator, design_text

REFERENCES = {
    "study": (2000.0, 0.0, 8.0),
    "dtlz2": (1.1, 1.1, 1.1),
    "dtlz5": (1.1, 1.1, 1.1),
    "dtlz7": (1.1, 1.1, 6.6),
    "welded-beam": (4.0, 2.0, 1.0),
}
STUDY = """
name = "three"
objectives = [{ minimize = "mass_kg" }, { maximize = "workspace_radius_m" }, { minimize = "footprint_m" }]
workspace.certify = false
hypervolume.reference = [2000.0, 0.0, 8.0]
"""
OURS = ("front-de", "nsga2")
THEIRS = ("NSGA-III", "AGE-MOEA2", "SMS-EMOA")


def volume(points, reference):
    return moocore.hypervolume(np.array(points), ref=np.array(reference)) if len(points) else 0.0


def own(job):
    problem, algorithm, evaluations, seed = job["problem"], job["algorithm"], job["evaluations"], job["seed"]
    if problem != "study":
        command = [job["example"], problem, algorithm, str(evaluations), str(seed)]
        return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    with tempfile.TemporaryDirectory() as folder:
        out, study = pathlib.Path(folder) / "run", pathlib.Path(folder) / "three.toml"
        study.write_text(STUDY)
        arguments = ["--algorithm", algorithm, "--evaluations", evaluations, "--seed", seed, "--threads", 1]
        command = [job["kinefront"], "optimize", study, *arguments, "--no-recording", "--quiet", "--out", out]
        subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
        with open(out / "designs.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["feasible"] == "true"]
    points = [[float(row["mass_kg"]), -float(row["workspace_radius_m"]), float(row["footprint_m"])] for row in rows]
    return volume(points, REFERENCES["study"])


def make(name, population):
    from pymoo.util.ref_dirs import get_reference_directions

    if name == "NSGA-III":
        from pymoo.algorithms.moo.nsga3 import NSGA3

        return NSGA3(get_reference_directions("das-dennis", 3, n_partitions=12))
    if name == "AGE-MOEA2":
        from pymoo.algorithms.moo.age2 import AGEMOEA2

        return AGEMOEA2(pop_size=population)
    from pymoo.algorithms.moo.sms import SMSEMOA

    return SMSEMOA(pop_size=population)


def their_problem(name, kinefront, met):
    from pymoo.core.problem import Problem
    from pymoo.problems import get_problem

    if name.startswith("dtlz"):
        inner = get_problem(name, n_var=22 if name == "dtlz7" else 12, n_obj=3)

        class Recorded(Problem):
            def __init__(self):
                super().__init__(n_var=inner.n_var, n_obj=3, xl=inner.xl, xu=inner.xu)

            def _evaluate(self, x, out, *args, **kwargs):
                out["F"] = inner.evaluate(x, return_values_of=["F"])
                met.extend(out["F"].tolist())

        return Recorded(), lambda: None
    if name == "welded-beam":

        class Beam(Problem):
            def __init__(self):
                super().__init__(n_var=4, n_obj=3, n_ieq_constr=4, xl=[0.125, 0.1, 0.1, 0.125], xu=[5.0, 10.0, 10.0, 5.0])

            def _evaluate(self, x, out, *args, **kwargs):
                h, l, t, b = x.T
                cost = 1.10471 * h * h * l + 0.04811 * t * b * (14.0 + l)
                deflection = 2.1952 / (t * t * t * b)
                primary = 6000.0 / (np.sqrt(2.0) * h * l)
                radius = np.sqrt(0.25 * (l * l + (h + t) ** 2))
                area = 2.0 * 0.707 * h * l * (l * l / 12.0 + 0.25 * (h + t) ** 2)
                secondary = 6000.0 * (14.0 + 0.5 * l) * radius / area
                shear = np.sqrt(primary**2 + secondary**2 + l * primary * secondary / radius)
                bending = 504_000.0 / (t * t * b)
                buckling = 64_746.022 * (1.0 - 0.0282346 * t) * t * b**3
                out["F"] = np.column_stack([cost / 10.0, 100.0 * deflection, shear / 13_600.0])
                out["G"] = np.column_stack(
                    [shear / 13_600.0 - 1.0, bending / 30_000.0 - 1.0, (h - b) / 5.0, 1.0 - buckling / 6000.0]
                )
                met.extend(out["F"][(out["G"] <= 0.0).all(axis=1)].tolist())

        return Beam(), lambda: None
    architectures = ["3-PRR", "3-RPR", "3-RRR"]
    folder = tempfile.TemporaryDirectory()
    study = pathlib.Path(folder.name) / "three.toml"
    study.write_text(STUDY)
    evaluator = Evaluator(kinefront, "--study", str(study))

    class Study(Problem):
        def __init__(self):
            super().__init__(n_var=6, n_obj=3, n_ieq_constr=1, xl=np.array(LOWER + [0.0]), xu=np.array(UPPER + [1.0]))

        def _evaluate(self, x, out, *args, **kwargs):
            places = np.minimum(x[:, 5] * 3, 2).astype(int)
            answers = evaluator([design_text(architectures[place], row[:5]) for place, row in zip(places, x)])
            footprints = [answer["quantities"].get("footprint_m", 8.0) for answer in answers]
            out["F"] = np.array(
                [[answer["mass_kg"], -answer["workspace_radius_m"], size] for answer, size in zip(answers, footprints)]
            )
            out["G"] = np.array([[answer["violation"]] for answer in answers])
            met.extend(point for point, answer in zip(out["F"].tolist(), answers) if answer["feasible"])

    return Study(), lambda: (evaluator.close(), folder.cleanup())


def theirs(job):
    from pymoo.optimize import minimize

    met = []
    problem, close = their_problem(job["problem"], job["kinefront"], met)
    minimize(problem, make(job["algorithm"], 92), ("n_eval", job["evaluations"]), seed=job["seed"])
    close()
    points = np.array(met)
    points = points[moocore.is_nondominated(points)] if len(points) else points
    return volume(points, REFERENCES[job["problem"]])


def run(job):
    path = pathlib.Path(job["out"]) / "{problem}-{algorithm}-{evaluations}-{seed}.json".format(**job)
    if not path.exists():
        found = own(job) if job["algorithm"] in OURS else theirs(job)
        path.write_text(json.dumps(found))
    return job["problem"], job["algorithm"], job["evaluations"], json.loads(path.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinefront")
    parser.add_argument("example")
    parser.add_argument("out")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--problems", default=",".join(REFERENCES))
    parser.add_argument("--algorithms", default=",".join(OURS + THEIRS))
    parser.add_argument("--evaluations", default="6000,30000")
    arguments = parser.parse_args()
    pathlib.Path(arguments.out).mkdir(parents=True, exist_ok=True)
    jobs = [
        {
            "kinefront": arguments.kinefront,
            "example": arguments.example,
            "out": arguments.out,
            "problem": problem,
            "algorithm": algorithm,
            "evaluations": int(evaluations),
            "seed": seed,
        }
        for evaluations in arguments.evaluations.split(",")
        for problem in arguments.problems.split(",")
        for algorithm in arguments.algorithms.split(",")
        for seed in range(1, arguments.seeds + 1)
    ]
    with multiprocessing.Pool(2) as pool:
        results = pool.map(run, jobs, chunksize=1)
    medians = {}
    for problem, algorithm, evaluations, found in results:
        medians.setdefault((problem, evaluations, algorithm), []).append(found)
    algorithms = arguments.algorithms.split(",")
    print("| problem | evaluations | " + " | ".join(algorithms) + " |")
    print("|---|---|" + "---|" * len(algorithms))
    for problem in arguments.problems.split(","):
        for evaluations in map(int, arguments.evaluations.split(",")):
            cells = [f"{statistics.median(medians[problem, evaluations, name]):.5g}" for name in algorithms]
            print(f"| {problem} | {evaluations} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
