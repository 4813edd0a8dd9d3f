"""Runs an external optimizer on Kinefront's evaluator: pymoo's NSGA-II over `kinefront evaluate --stdin`.

    python tests/python/pymoo_nsga2.py PATH/TO/kinefront [POPULATION] [GENERATIONS]

Prints one JSON object: the front as [mass_kg, workspace_radius_m] pairs and the hypervolume against (2000 kg, 0 m)
after the first and the last generation.
"""

import json
import subprocess
import sys
import threading

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.indicators.hv import HV
from pymoo.optimize import minimize


class Kinefront(Problem):
    """3-PRR designs within the paper's bounds, with the objectives of smallest mass and largest workspace radius."""

    def __init__(self, program):
        super().__init__(
            n_var=5, n_obj=2, n_ieq_constr=1, xl=np.array([0.5, 0.1, 0.5, 0.0, 0.0]), xu=np.array([4, 4, 4, 0.1, 0.1])
        )
        self.process = subprocess.Popen(
            [program, "evaluate", "--stdin"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def _evaluate(self, x, out, *args, **kwargs):
        lines = "".join(
            "3-PRR " + " ".join(f"{key}={value!r}" for key, value in zip(("R", "r", "Lb", "rj", "rp"), map(float, row))) + "\n"
            for row in x
        )

        # Answers arrive while lines are still being sent: a thread writes them, so that neither pipe fills up.
        def write():
            self.process.stdin.write(lines)
            self.process.stdin.flush()

        writer = threading.Thread(target=write)
        writer.start()
        answers = [json.loads(self.process.stdout.readline()) for _ in x]
        writer.join()
        out["F"] = np.array([[answer["mass_kg"], -answer["workspace_radius_m"]] for answer in answers])
        out["G"] = np.array([[answer["violation"]] for answer in answers])


def main():
    program = sys.argv[1]
    population = int(sys.argv[2]) if len(sys.argv) > 2 else 40
    generations = int(sys.argv[3]) if len(sys.argv) > 3 else 20
    problem = Kinefront(program)
    volume = HV(ref_point=np.array([2000.0, 0.0]))
    hypervolumes = []

    def record(algorithm):
        feasible = algorithm.pop[np.ravel(algorithm.pop.get("feas"))]
        hypervolumes.append(float(volume(feasible.get("F"))) if len(feasible) else 0.0)

    result = minimize(problem, NSGA2(pop_size=population), ("n_gen", generations), seed=1, callback=record)
    problem.process.stdin.close()
    problem.process.wait()

    front = sorted([float(mass), float(-radius)] for mass, radius in result.F)
    print(
        json.dumps(
            {
                "front": front,
                "first_hypervolume": hypervolumes[0],
                "last_hypervolume": hypervolumes[-1],
            }
        )
    )


if __name__ == "__main__":
    main()
