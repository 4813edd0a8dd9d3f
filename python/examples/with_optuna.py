"""Search a study by a sampler of Optuna."""

import sys

import optuna

import kinefront
from kinefront.optuna import Objective

quick = "--quick" in sys.argv
objective = Objective(kinefront.Study.paper())
sampler = optuna.samplers.NSGAIISampler(seed=1)
search = optuna.create_study(directions=objective.directions, sampler=sampler)
search.optimize(objective, n_trials=30 if quick else 2000)
for trial in search.best_trials[:5]:
    print(f"{trial.values[0]:8.1f} kg, R_w {trial.values[1]:.3f} m: {trial.params}")
