"""Evaluate designs by the thousand, search for a front, and plot it."""

import sys

import matplotlib
import numpy as np

import kinefront

matplotlib.use("Agg")
from matplotlib import pyplot

quick = "--quick" in sys.argv
study = kinefront.Study.paper()
random = np.random.default_rng(1)
count = 2_000 if quick else 100_000
columns = {name: random.uniform(low, high, count) for name, (low, high) in study.bounds.items()}
columns["architecture"] = random.choice(study.architectures, count)
designs = study.evaluate(columns)
run = study.optimize(seed=1, evaluations=300 if quick else 6000)

found = designs["feasible"]
pyplot.scatter(designs["mass_kg"][found], designs["workspace_radius_m"][found], s=1, color="0.7", label="at random")
pyplot.plot(run.front["mass_kg"], run.front["workspace_radius_m"], ".-", label="front")
pyplot.xscale("log")
pyplot.xlabel("mass in motion [kg]")
pyplot.ylabel("$R_w$ [m]")
pyplot.legend()
pyplot.savefig("front.png", dpi=120)
