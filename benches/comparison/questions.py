"""Measures how well questions of machine builders are searched: eight studies beside the paper's, in `questions/`.

    python -m pip install -r benches/comparison/requirements.txt
    python benches/comparison/questions.py run PROGRAM... [--evaluations 3000] [--seeds 7] [--from 1] [--only NAME,NAME] [--others [pymoo,Optuna]] [--other-seeds 3]
    python benches/comparison/questions.py make PROGRAM [--evaluations 30000] [--seeds 5] [--from 101] [--only NAME,NAME]

`run` prints a table. For a question with one objective, a cell is by how many per cent the lightest design of `front.csv` is above the
best one known, and otherwise the hypervolume of `front.csv` as a percentage of that of the reference front: the median over the random
seeds and the worst one, and the median of the seconds of the search. An objective whose values on the reference front span more than a
factor of ten counts by its logarithm; each is scaled to these values, and the reference point is a tenth of them beyond the worst.
Values are those of the fine grid; no proofs are made. With `--others`, the optimizers of pymoo and Optuna answer the same questions through
the Python package `kinefront`, with as many evaluations. Programs take turns, so that the load of the machine cancels.

`make` searches each question with a larger budget and several seeds, and writes the best designs to `assets/reference_fronts/questions/`.
A front that is there is improved, never worsened.
"""

import argparse
import csv
import math
import pathlib
import statistics
import subprocess
import tempfile
import time
import tomllib

import moocore
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
FRONTS = HERE.parents[1] / "assets/reference_fronts/questions"
DESIGN = ("architecture", "working_mode", "R", "r", "Lb", "rj", "rp", "La", "alpha_deg", "beta_deg", "gamma_deg")
# Quantities that are constraints have columns of their own.
CONSTRAINTS = {"dexterity": "value_g3", "k_xy_n_per_m": "value_g4", "k_z_n_per_m": "value_g5", "k_phi_z_nm_per_rad": "value_g6"}
# More designs than a front has that a person reads.
WHOLE = 400


class Question:
    """A study with its objectives and its reference front."""

    def __init__(self, path):
        self.path, self.name = path, path.stem
        stated = tomllib.loads(path.read_text()).get("objectives")
        stated = stated or [{"minimize": "mass_kg"}, {"maximize": "workspace_radius_m"}]
        self.columns = [key for objective in stated for key in objective.values()]
        self.signs = np.array([1.0 if "minimize" in objective else -1.0 for objective in stated])
        self.front = FRONTS / f"{self.name}.csv"

    def read(self, path):
        """The designs of a table, and their objectives."""
        with open(path, newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row.get("feasible", "true") == "true"]
        for row in rows:
            row.update({column: row[CONSTRAINTS[column]] for column in self.columns if column not in row})
        values = np.array([[float(row[column]) for column in self.columns] for row in rows])
        return rows, values.reshape(len(rows), len(self.columns))

    def scaled(self, values, reference):
        """Objectives to be minimised, from 0 to 1 over the reference front."""
        best, worst = reference.min(axis=0), reference.max(axis=0)
        scaled = np.empty_like(values)
        for k in range(values.shape[1]):
            low, high, column = best[k], worst[k], values[:, k]
            if low > 0.0 and high > 10.0 * low:
                low, high, column = math.log(low), math.log(high), np.log(np.maximum(column, 1e-300))
            share = (column - low) / (high - low)
            scaled[:, k] = share if self.signs[k] > 0.0 else 1.0 - share
        return scaled

    def quality(self, values):
        """Per cent of the reference front's hypervolume, or per cent above the best value known."""
        _, reference = self.read(self.front)
        if len(self.columns) == 1:
            best = (reference * self.signs).min()
            return 100.0 * ((values * self.signs).min() / best - 1.0) if len(values) else math.inf
        if not len(values):
            return 0.0
        point = [1.1] * len(self.columns)
        volumes = [moocore.hypervolume(self.scaled(found, reference), ref=point) for found in (values, reference)]
        return 100.0 * float(volumes[0]) / float(volumes[1])

    def search(self, program, evaluations, seed, settings=""):
        """Searches as a user does, without proofs and recording; returns the folder's front, and the seconds of the command."""
        with tempfile.TemporaryDirectory() as folder:
            out, study = pathlib.Path(folder) / "run", pathlib.Path(folder) / self.path.name
            study.write_text(with_settings(self.path.read_text(), settings), encoding="utf-8")
            command = [program, "optimize", study, "--quiet", "--no-recording", "--evaluations", evaluations, "--seed", seed]
            start = time.perf_counter()
            subprocess.run([*map(str, command), "--out", str(out)], check=True, stdout=subprocess.DEVNULL)
            seconds = time.perf_counter() - start
            rows, values = self.read(out / "front.csv")
            return rows, values, seconds


def with_settings(text, settings):
    """Adds lines to the table `[optimizer]` of a study, and leaves out its proofs."""
    text = text.replace("[optimizer]\n", f"[optimizer]\n{settings}") if "[optimizer]\n" in text else f"{text}\n[optimizer]\n{settings}"
    return f"{text}\n[workspace]\ncertify = false\n"


def questions(only):
    found = {path.stem: Question(path) for path in sorted((HERE / "questions").glob("*.toml"))}
    wanted = only.split(",") if only else list(found)
    unknown = [name for name in wanted if name not in found]
    if unknown:
        raise SystemExit(f"there is no question {', '.join(unknown)}; there are: {', '.join(found)}")
    return [found[name] for name in wanted]


def make(arguments):
    FRONTS.mkdir(parents=True, exist_ok=True)
    for question in questions(arguments.only):
        rows, values = question.read(question.front) if question.front.exists() else ([], np.empty((0, len(question.columns))))
        for seed in range(arguments.first, arguments.first + arguments.seeds):
            more, found, seconds = question.search(arguments.programs[0], arguments.evaluations, seed, f"front_designs = {WHOLE}\n")
            print(f"{question.name} seed {seed}: {len(more)} designs, {seconds:.0f} s", flush=True)
            rows, values = rows + more, np.vstack([values, found])
        signed = values * question.signs
        kept = [k for k in np.lexsort(signed.T[::-1]) if not is_dominated(signed, k)]
        columns = [column for column in DESIGN if any(rows[k].get(column) for k in kept)] + question.columns
        with open(question.front, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns, extrasaction="ignore", lineterminator="\n")
            writer.writeheader()
            writer.writerows({column: short(rows[k].get(column, "")) for column in columns} for k in kept)


def short(value):
    """A number with the digits that a comparison needs."""
    try:
        return f"{float(value):.8g}"
    except ValueError:
        return value


def is_dominated(signed, place):
    others = np.all(signed <= signed[place], axis=1)
    better = others & np.any(signed < signed[place], axis=1)
    equal = others & np.all(signed == signed[place], axis=1)
    return bool(better.any() or equal[:place].any())


def pymoo(algorithm):
    """Returns a function that answers a question with an algorithm of pymoo; the architecture is a real variable if there are several."""

    def run(question, evaluations, seed):
        import kinefront
        from kinefront.pymoo import StudyProblem
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize

        study = kinefront.Study.read(str(question.path))
        inner = StudyProblem(study)
        architectures = list(study.architectures)
        met = []

        class Asked(Problem):
            def __init__(self):
                several = [1.0] if len(architectures) > 1 else []
                low, high = np.append(inner.xl, [0.0 for _ in several]), np.append(inner.xu, several)
                super().__init__(n_var=len(low), n_obj=inner.n_obj, n_ieq_constr=1, xl=low, xu=high)

            def _evaluate(self, x, out, *args, **kwargs):
                columns = inner.designs(x[:, : len(inner.xl)])
                if len(architectures) > 1:
                    places = np.minimum(x[:, -1] * len(architectures), len(architectures) - 1).astype(int)
                    columns["architecture"] = np.array([architectures[place] for place in places])
                else:
                    columns["architecture"] = np.array([architectures[0]] * len(x))
                met.append({name: np.asarray(column) for name, column in columns.items()})
                table = study.evaluate(columns)
                values = np.column_stack([table[name] for name in study.objective_columns]) * question.signs
                out["F"] = np.where(np.isnan(values), 1e300, values)
                out["G"] = table["violation"][:, None]

        minimize(Asked(), algorithm(), ("n_eval", evaluations), seed=seed)
        return fine(question, study, {name: np.concatenate([part[name] for part in met]) for name in met[0]})

    return run


def fine(question, study, columns):
    """The objectives, on the fine grid, of those of some designs that are feasible and not dominated."""
    table = study.evaluate(columns)
    values = np.column_stack([table[name] for name in study.objective_columns])
    good = np.flatnonzero((np.asarray(table["violation"]) == 0.0) & ~np.isnan(values).any(axis=1))
    signed = values[good] * question.signs
    kept = [good[k] for k in range(len(good)) if not is_dominated(signed, k)]
    if not kept:
        return np.empty((0, len(question.columns)))
    table = study.evaluate({name: column[kept] for name, column in columns.items()}, grid="fine")
    values = np.column_stack([table[name] for name in study.objective_columns])
    return values[(np.asarray(table["violation"]) == 0.0) & ~np.isnan(values).any(axis=1)]


def optuna_tpe(question, evaluations, seed):
    import kinefront
    import optuna
    from kinefront.optuna import Objective

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    study = kinefront.Study.read(str(question.path))
    objective = Objective(study)
    trials = optuna.create_study(directions=objective.directions, sampler=optuna.samplers.TPESampler(seed=seed, multivariate=True))
    trials.optimize(objective, n_trials=evaluations)
    designs = [objective.design(trial) for trial in trials.trials]
    return fine(question, study, {name: np.array([design[name] for design in designs]) for name in designs[0]})


def nsga2():
    from pymoo.algorithms.moo.nsga2 import NSGA2

    return NSGA2(pop_size=100)


def de():
    from pymoo.algorithms.moo.gde3 import GDE3

    return GDE3(pop_size=60)


OTHERS = {"pymoo NSGA-II": pymoo(nsga2), "pymoo GDE3": pymoo(de), "Optuna TPE": optuna_tpe}


def run(arguments):
    others = {}
    if arguments.others is not None:
        others = {name: other for name, other in OTHERS.items() if any(part in name for part in arguments.others.split(","))}
    names = [pathlib.Path(program).name for program in arguments.programs]
    print("| question | | " + " | ".join([*names, *others]) + " | search |")
    print("|---|---|" + "---:|" * (len(names) + len(others) + 1))
    for question in questions(arguments.only):
        found, seconds = {name: [] for name in [*names, *others]}, []
        for seed in range(arguments.first, arguments.first + arguments.seeds):
            for name, program in zip(names, arguments.programs):
                _, values, taken = question.search(program, arguments.evaluations, seed)
                found[name].append(question.quality(values))
                seconds.append(taken)
            for name, other in others.items() if seed < arguments.first + arguments.other_seeds else ():
                found[name].append(question.quality(other(question, arguments.evaluations, seed)))
        one = len(question.columns) == 1
        worst = max if one else min
        digits = 3 if one else 2
        cells = [f"{statistics.median(of):.{digits}f} ({worst(of):.{digits}f})" for of in found.values()]
        kind = "% above the best" if one else "% of hypervolume"
        print(f"| {question.name} | {kind} | " + " | ".join(cells) + f" | {statistics.median(seconds):.1f} s |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    for name, command, evaluations, seeds, first in (("run", run, 3000, 7, 1), ("make", make, 30_000, 5, 101)):
        part = commands.add_parser(name)
        part.add_argument("programs", nargs="+")
        part.add_argument("--evaluations", type=int, default=evaluations)
        part.add_argument("--seeds", type=int, default=seeds)
        part.add_argument("--from", dest="first", type=int, default=first)
        part.add_argument("--only", help="questions of these names")
        part.set_defaults(command=command)
        if command is run:
            part.add_argument("--others", nargs="?", const="", help="all other optimizers, or those whose names contain one of these: pymoo,Optuna")
            part.add_argument("--other-seeds", type=int, default=3, help="random seeds of the other optimizers")
    arguments = parser.parse_args()
    arguments.command(arguments)


if __name__ == "__main__":
    main()
