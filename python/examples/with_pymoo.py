"""Search a study by an algorithm of pymoo."""

import sys

from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.optimize import minimize

import kinefront
from kinefront.pymoo import StudyProblem

quick = "--quick" in sys.argv
problem = StudyProblem(kinefront.Study.paper(), "3-PRR")
result = minimize(problem, NSGA2(pop_size=20 if quick else 100), ("n_gen", 5 if quick else 60), seed=1)
for x, (mass, radius) in list(zip(result.X, result.F))[:5] if result.X is not None else []:
    print(f"{mass:8.1f} kg, R_w {-radius:.3f} m: {problem.study.designs(problem.designs(x[None]))[0]}")
