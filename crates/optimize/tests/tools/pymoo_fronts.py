"""What pymoo's NSGA-II reaches on test problems of the field: the numbers in crates/optimize/tests/fixtures/pymoo_nsga2.json.

    python crates/optimize/tests/tools/pymoo_fronts.py > crates/optimize/tests/fixtures/pymoo_nsga2.json

Population 100, pymoo's own operators, 20 000 evaluations, seeds 1 to 11. The hypervolume is that of all feasible
candidates evaluated, as `kinefront_optimize::drive` keeps them too.
"""

import json
import multiprocessing
import statistics

import numpy as np
import pymoo
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.indicators.hv import HV
from pymoo.optimize import minimize
from pymoo.problems import get_problem

EVALUATIONS = 20_000
SEEDS = range(1, 12)
REFERENCES = {
    "bnh": [150.0, 55.0],
    "osy": [0.0, 80.0],
    "tnk": [1.2, 1.2],
    "srn": [250.0, 50.0],
    "zdt1": [1.1, 1.1],
    "zdt2": [1.1, 1.1],
    "zdt3": [1.1, 1.1],
    "zdt4": [1.1, 1.1],
    "zdt6": [1.1, 1.1],
}


def run(job):
    name, seed = job
    problem = get_problem(name)
    seen = []

    def keep(algorithm):
        population = algorithm.off if algorithm.off is not None else algorithm.pop
        seen.append(population[np.ravel(population.get("feas"))].get("F"))

    minimize(problem, NSGA2(pop_size=100), ("n_eval", EVALUATIONS), seed=seed, callback=keep)
    points = np.vstack([front for front in seen if len(front)])
    points = points[np.lexsort(points.T[::-1])]
    front, lowest = [], np.inf
    for point in points:
        if point[1] < lowest:
            front.append(point)
            lowest = point[1]
    return float(HV(ref_point=np.array(REFERENCES[name]))(np.array(front)))


def main():
    jobs = [(name, seed) for name in REFERENCES for seed in SEEDS]
    with multiprocessing.Pool() as pool:
        volumes = dict(zip(jobs, pool.map(run, jobs, chunksize=1)))
    problems = {
        name: {
            "reference": REFERENCES[name],
            "hypervolumes": sorted(volumes[name, seed] for seed in SEEDS),
            "median": statistics.median(volumes[name, seed] for seed in SEEDS),
        }
        for name in REFERENCES
    }
    origin = f"pymoo {pymoo.__version__}, NSGA-II with population 100; made by crates/optimize/tests/tools/pymoo_fronts.py"
    print(json.dumps({"origin": origin, "evaluations": EVALUATIONS, "problems": problems}, indent=1))


if __name__ == "__main__":
    main()
