"""Compares Kinefront's optimizers with those of pymoo and fcmaes-core on the paper's study, all on Kinefront's
evaluator.

    python -m pip install -r benches/comparison/requirements.txt
    python -m pip install -r benches/comparison/requirements-models.txt    # for BoTorch and SMAC
    cargo build --release --no-default-features
    (cd benches/comparison/mode && cargo build --release)
    python benches/comparison/compare.py run target/release/kinefront benches/comparison/mode/target/release/mode OUT \
        [--evaluations 6000] [--from 0] [--seeds 11] [--architectures 3-PRR,3-RPR,3-RRR] [--only NAME,NAME]
    python benches/comparison/compare.py run target/release/kinefront benches/comparison/mode/target/release/mode OUT \
        --evaluations 300 --only BoTorch,SMAC
    python benches/comparison/compare.py table OUT [--plot screenshots/comparison.png]

The quality of a run after N evaluations is the hypervolume of the non-dominated designs among its first N designs,
with every radius from the fine grid, as a fraction of the hypervolume of the reference front
(`assets/reference_fronts`), with the reference point at 2000 kg and a radius of 0; it is also computed with the
logarithm of the mass. moocore computes the hypervolumes. The candidates of other programs are evaluated through
`kinefront evaluate --stdin`; for these programs the architecture is a real variable whose range is divided into equal
parts. The optimizers of BoTorch and SMAC know it as a category (`model_based.py`); they take minutes for 300 evaluations,
so that they run only if `--only` names them. A run that is already in OUT is not repeated. The search of an optimizer
does not depend on its budget, so a longer run continues a shorter one: with `--from`, only the later part is measured,
and the table combines both.
"""

import argparse
import csv
import json
import math
import multiprocessing
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import moocore
import numpy as np

KEYS = ("R", "r", "Lb", "rj", "rp")
LOWER = [0.5, 0.1, 0.5, 0.0, 0.0]
UPPER = [4.0, 4.0, 4.0, 0.1, 0.1]
MARKS = (250, 300, 500, 1000, 2000, 3000, 4000, 6000, 15_000, 30_000)
ALL = "3-PRR,3-RPR,3-RRR"
ROOT = pathlib.Path(__file__).resolve().parents[2]


class Evaluator:
    """A process of `kinefront evaluate --stdin`: takes designs as text and returns the answers in order."""

    def __init__(self, program, *more):
        command = [program, "evaluate", "--stdin", *more]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __call__(self, designs):
        # Answers arrive while lines are still being sent: a thread writes them, so that neither pipe fills up.
        def write():
            self.process.stdin.write("".join(design + "\n" for design in designs))
            self.process.stdin.flush()

        writer = threading.Thread(target=write)
        writer.start()
        answers = [json.loads(self.process.stdout.readline()) for _ in designs]
        writer.join()
        return answers

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def design_text(architecture, values):
    return architecture + " " + " ".join(f"{key}={float(value)!r}" for key, value in zip(KEYS, values))


def own(algorithm, study=""):
    """Return a function that runs one of Kinefront's algorithms as its users run it, on the paper's study with the given changes."""

    def run(job):
        with tempfile.TemporaryDirectory() as folder:
            out, file = pathlib.Path(folder) / "run", pathlib.Path(folder) / "study.toml"
            file.write_text(study)
            arguments = ["--algorithm", algorithm, "--evaluations", job["evaluations"], "--seed", job["seed"]]
            arguments += ["--architectures", job["architectures"], "--threads", 1, "--quiet", "--out", out]
            command = [job["kinefront"], "optimize", file, *map(str, arguments)]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            with open(out / "designs.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            report = json.loads((out / "run.json").read_text())
        found = [(float(row["mass_kg"]), float(row["workspace_radius_m"])) for row in rows]
        volume = hypervolume([point for point in found if point[1] > 0.0])
        assert math.isclose(volume, report["hypervolume_kg_m"], rel_tol=1e-9), "moocore and Kinefront differ"
        return [(design_text(row["architecture"], [row[key] for key in KEYS]), *point) for row, point in zip(rows, found)]

    return run


def pymoo_algorithm(make):
    """Return a function that runs one of pymoo's algorithms with its defaults, except for the population."""

    def run(job):
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize

        architectures = job["architectures"].split(",")
        several = len(architectures) > 1
        evaluator = Evaluator(job["kinefront"])
        met = []

        class Study(Problem):
            def __init__(self):
                more = [0.0] if several else []
                lower, upper = np.array(LOWER + more), np.array(UPPER + [1.0 for _ in more])
                super().__init__(n_var=len(lower), n_obj=2, n_ieq_constr=1, xl=lower, xu=upper)

            def _evaluate(self, x, out, *args, **kwargs):
                places = np.minimum(x[:, 5] * len(architectures), len(architectures) - 1) if several else np.zeros(len(x))
                designs = [design_text(architectures[int(place)], row[:5]) for place, row in zip(places, x)]
                answers = evaluator(designs)
                met.extend(
                    (design, answer["mass_kg"], answer["workspace_radius_m"]) for design, answer in zip(designs, answers)
                )
                out["F"] = np.array([[answer["mass_kg"], -answer["workspace_radius_m"]] for answer in answers])
                out["G"] = np.array([[answer["violation"]] for answer in answers])

        minimize(Study(), make(), ("n_eval", job["evaluations"]), seed=job["seed"])
        evaluator.close()
        return met

    return run


def nsga2(population):
    from pymoo.algorithms.moo.nsga2 import NSGA2

    return NSGA2(pop_size=population)


def gde3():
    from pymoo.algorithms.moo.gde3 import GDE3

    return GDE3(pop_size=60)


def sms_emoa():
    from pymoo.algorithms.moo.sms import SMSEMOA

    return SMSEMOA(pop_size=100)


def c_taea():
    from pymoo.algorithms.moo.ctaea import CTAEA
    from pymoo.util.ref_dirs import get_reference_directions

    return CTAEA(ref_dirs=get_reference_directions("das-dennis", 2, n_partitions=59))


def mode(job):
    """Run MODE of fcmaes-core with its defaults."""
    arguments = [job["kinefront"], job["architectures"], job["evaluations"], job["seed"], 64]
    printed = subprocess.run([job["mode"], *map(str, arguments)], check=True, capture_output=True, text=True)
    designs = printed.stdout.splitlines()[: job["evaluations"]]
    evaluator = Evaluator(job["kinefront"])
    answers = evaluator(designs)
    evaluator.close()
    return [(design, answer["mass_kg"], answer["workspace_radius_m"]) for design, answer in zip(designs, answers)]


def model_based(name):
    """Return a function that runs an optimizer of `model_based.py`."""

    def run(job):
        import model_based

        evaluator = Evaluator(job["kinefront"])
        met = getattr(model_based, name)(job, evaluator, design_text, LOWER, UPPER)
        evaluator.close()
        return met

    return run


ALGORITHMS = {
    "Kinefront front-de": own("front-de"),
    "Kinefront front-de, `learned = 0`": own("front-de", "[optimizer.front_de]\nlearned = 0.0\n"),
    "Kinefront NSGA-II": own("nsga2"),
    "Kinefront MOGA-II (reimplementation)": own("moga2"),
    "pymoo NSGA-II, population 30": pymoo_algorithm(lambda: nsga2(30)),
    "pymoo NSGA-II, population 100": pymoo_algorithm(lambda: nsga2(100)),
    "pymoo GDE3, population 60": pymoo_algorithm(gde3),
    "pymoo SMS-EMOA, population 100": pymoo_algorithm(sms_emoa),
    "pymoo C-TAEA, 60 directions": pymoo_algorithm(c_taea),
    "fcmaes-core MODE, population 64": mode,
    "BoTorch qLogEHVI, Gaussian process": model_based("qehvi"),
    "SMAC ParEGO, random forest": model_based("parego"),
}

# They run only if they are named.
EXPENSIVE = ("BoTorch", "SMAC")


def hypervolume(points, logarithmic=False):
    """Return the hypervolume of (mass, radius) pairs with the reference point (2000 kg, 0 m)."""
    points = [(mass, -radius) for mass, radius in points if mass < 2000.0]
    if not points:
        return 0.0
    points = np.array(points)
    reference = [2000.0, 0.0]
    if logarithmic:
        points[:, 0] = np.log(points[:, 0])
        reference[0] = math.log(2000.0)
    return float(moocore.hypervolume(points, ref=reference))


def front(designs):
    """Return the feasible and non-dominated designs among tuples (design, mass, radius)."""
    kept, largest = [], 0.0
    for design in sorted(designs, key=lambda design: (design[1], -design[2])):
        if design[2] > largest:
            kept.append(design)
            largest = design[2]
    return kept


def reference_front(architectures):
    name = "combined" if architectures == ALL else architectures
    with open(ROOT / "assets/reference_fronts" / f"{name}.csv", newline="") as file:
        return [(float(row["mass_kg"]), float(row["workspace_radius_m"])) for row in csv.DictReader(file)]


def measure(job):
    if job["file"].exists():
        return
    start = time.perf_counter()
    met = ALGORITHMS[job["algorithm"]](job)
    seconds = time.perf_counter() - start
    marks = [mark for mark in MARKS if job["from"] <= mark <= job["evaluations"]]
    fronts = {mark: [design for design, _, _ in front(met[:mark])] for mark in marks}
    designs = sorted(set().union(*fronts.values()))
    evaluator = Evaluator(job["kinefront"], "--grid", "fine")
    fine = {
        design: (answer["mass_kg"], answer["workspace_radius_m"])
        for design, answer in zip(designs, evaluator(designs))
        if answer["feasible"]
    }
    evaluator.close()
    volumes = {}
    for mark in marks:
        points = [fine[design] for design in fronts[mark] if design in fine]
        volumes[mark] = [hypervolume(points), hypervolume(points, logarithmic=True)]
    result = {key: job[key] for key in ("algorithm", "architectures", "seed", "evaluations")}
    result |= {"seconds": seconds, "hypervolumes": volumes}
    job["file"].write_text(json.dumps(result, indent=1) + "\n")
    print(f"{job['algorithm']:34} {job['architectures']:18} seed {job['seed']:2}: {seconds:.1f} s", flush=True)


def run(arguments):
    arguments.out.mkdir(parents=True, exist_ok=True)
    if arguments.only:
        names = [name for name in ALGORITHMS if any(part in name for part in arguments.only.split(","))]
        if not names:
            sys.exit(f"no algorithm's name contains any of {arguments.only}; there are: {'; '.join(ALGORITHMS)}")
    else:
        names = [name for name in ALGORITHMS if not name.startswith(EXPENSIVE)]
    jobs = []
    for seed in range(1, arguments.seeds + 1):
        for name in names:
            slug = "".join(c if c.isalnum() else "-" for c in f"{name}-{arguments.architectures}")
            jobs.append(
                {
                    "algorithm": name,
                    "architectures": arguments.architectures,
                    "seed": seed,
                    "evaluations": arguments.evaluations,
                    "from": getattr(arguments, "from"),
                    "kinefront": str(arguments.kinefront.resolve()),
                    "mode": str(arguments.mode.resolve()),
                    "file": arguments.out / f"{slug}-{arguments.evaluations}-{seed}.json",
                }
            )
    with multiprocessing.Pool() as pool:
        for _ in pool.imap_unordered(measure, jobs, chunksize=1):
            pass


def table(arguments):
    seeds = {}
    for file in sorted(arguments.out.glob("*.json")):
        result = json.loads(file.read_text())
        key = (result["architectures"], result["algorithm"], result["seed"])
        seeds.setdefault(key, result)["hypervolumes"] |= result["hypervolumes"]
    if not seeds:
        sys.exit(f"{arguments.out} holds no results; `compare.py run KINEFRONT MODE OUT` makes them")
    cases = {}
    for (architectures, algorithm, _), result in seeds.items():
        cases.setdefault(architectures, {}).setdefault(algorithm, []).append(result)
    for architectures, algorithms in sorted(cases.items(), key=lambda case: -len(case[0])):
        reference = reference_front(architectures)
        whole = [hypervolume(reference), hypervolume(reference, logarithmic=True)]
        print(f"\n{architectures}: median (worst) fraction of the reference front's hypervolume\n")
        measured = marks_of(algorithms)
        budgets = [budget for budget in (300, 1000, 6000, 30_000) if budget in measured]
        heads = [f"{budget}, {seeds_of(algorithms, budget)} seeds | with log mass" for budget in budgets]
        print("| | " + " | ".join(heads) + " | 90 / 95 / 99 % after |")
        print("|---|" + "---:|---:|" * len(budgets) + "---:|")
        for name in ALGORITHMS:
            results = algorithms.get(name)
            if not results:
                continue
            cells = []
            for budget in budgets:
                for kind in range(2):
                    shares = [r["hypervolumes"][str(budget)][kind] / whole[kind] for r in results if str(budget) in r["hypervolumes"]]
                    cells.append(f"{100 * statistics.median(shares):.2f} ({100 * min(shares):.2f})" if shares else "–")
            after = " / ".join(evaluations_to(results, share, whole[0]) for share in (0.9, 0.95, 0.99))
            print(f"| {name} | " + " | ".join(cells) + f" | {after} |")
    if arguments.plot:
        plot(arguments.plot, cases)


def marks_of(algorithms):
    """Return the numbers of evaluations after which any run was measured."""
    return {int(mark) for results in algorithms.values() for result in results for mark in result["hypervolumes"]}


def seeds_of(algorithms, budget):
    counts = {sum(str(budget) in result["hypervolumes"] for result in results) for results in algorithms.values()}
    return " or ".join(map(str, sorted(counts)))


def curve(results, whole):
    """Return the marks and, for each, the fractions reached by the random seeds that have the mark."""
    shares = {
        mark: [result["hypervolumes"][str(mark)][0] / whole for result in results if str(mark) in result["hypervolumes"]]
        for mark in MARKS
    }
    return [mark for mark in MARKS if shares[mark]], [at for at in shares.values() if at]


def evaluations_to(results, share, whole):
    """Return the first mark at which the median over the random seeds has reached a fraction."""
    for mark, shares in zip(*curve(results, whole)):
        if statistics.median(shares) >= share:
            return str(mark)
    return "–"


def plot(path, cases):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    # Only cases with several algorithms are plotted.
    cases = {architectures: algorithms for architectures, algorithms in cases.items() if len(algorithms) > 1}
    figure, axes = plt.subplots(1, len(cases), figsize=(8.0 * len(cases), 4.6), squeeze=False, layout="constrained")
    for axis, (architectures, algorithms) in zip(axes[0], sorted(cases.items(), key=lambda case: -len(case[0]))):
        whole = hypervolume(reference_front(architectures))
        measured = marks_of(algorithms)
        for index, name in enumerate(name for name in ALGORITHMS if name in algorithms):
            marks, shares = curve(algorithms[name], whole)
            ours = name.startswith("Kinefront")
            missing = [100 * (1 - statistics.median(at)) for at in shares]
            axis.plot(marks, missing, label=name.replace("`", ""), color=f"C{index}", lw=2.2 if ours else 1.3, ls="-" if ours else "--")
            axis.fill_between(
                marks, [100 * (1 - min(at)) for at in shares], [100 * (1 - max(at)) for at in shares], color=f"C{index}", alpha=0.12
            )
        axis.set(xscale="log", yscale="log", title=architectures.replace(",", ", "), xlabel="evaluations")
        axis.set_ylabel("missing part of the reference front's hypervolume [%]")
        ticks = [0.1, 0.3, 1, 3, 10, 30]
        axis.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
        ticks = [tick for tick in (250, 1000, 6000, 30_000) if tick in measured]
        axis.set_xticks(ticks, [f"{tick}" for tick in ticks])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run")
    for name in ("kinefront", "mode", "out"):
        runner.add_argument(name, type=pathlib.Path)
    runner.add_argument("--evaluations", type=int, default=6000)
    runner.add_argument("--from", type=int, default=0)
    runner.add_argument("--seeds", type=int, default=11)
    runner.add_argument("--architectures", default=ALL)
    runner.add_argument("--only", help="algorithms whose names contain one of these")
    runner.set_defaults(command=run)
    teller = commands.add_parser("table")
    teller.add_argument("out", type=pathlib.Path)
    teller.add_argument("--plot", type=pathlib.Path)
    teller.set_defaults(command=table)
    arguments = parser.parse_args()
    arguments.command(arguments)


if __name__ == "__main__":
    main()
