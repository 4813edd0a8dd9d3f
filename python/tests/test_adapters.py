"""The adapters to pymoo, Optuna, Dask and Rerun."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from kinefront import Study, sweeps

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.fixture(scope="module")
def study():
    return Study.paper().replace("[workspace]\ncertify = false\n")


def test_pymoo_minimises_what_the_study_asks(study):
    pytest.importorskip("pymoo")
    from kinefront.pymoo import StudyProblem

    problem = StudyProblem(study, "3-PRR")
    x = np.random.default_rng(0).uniform(problem.xl, problem.xu, (20, problem.n_var))
    out = problem.evaluate(x, return_as_dictionary=True)
    table = study.evaluate(problem.designs(x))
    assert np.array_equal(out["F"][:, 0], table["mass_kg"]) and np.array_equal(out["F"][:, 1], -table["workspace_radius_m"])
    assert np.array_equal(out["G"][:, 0] <= 0, table["feasible"])


def test_optuna_suggests_designs(study):
    optuna = pytest.importorskip("optuna")
    from kinefront.optuna import Objective

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    objective = Objective(study)
    assert objective.directions == ["minimize", "maximize"]
    sampler = optuna.samplers.NSGAIISampler(seed=1, population_size=8)
    search = optuna.create_study(directions=objective.directions, sampler=sampler)
    search.optimize(objective, n_trials=16)
    trial = search.trials[0]
    table = study.evaluate({name: value for name, value in trial.params.items()})
    assert trial.values == [table["mass_kg"][0], table["workspace_radius_m"][0]]
    assert objective.constraints(trial) == [table["violation"][0]]


LISTED = """
architectures = ["3-PRR"]
[sections]
legs = { kind = "tube", catalogue = "en-10255-medium" }
[variables]
R_m = [2.0, 2.5, 3.0]
rp_m = "2 rj"
[workspace]
certify = false
"""


def test_optuna_and_pymoo_keep_to_lists_catalogues_and_ties(study):
    optuna, _ = pytest.importorskip("optuna"), pytest.importorskip("pymoo")
    from kinefront.optuna import Objective
    from kinefront.pymoo import StudyProblem

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    listed = Study.paper().replace(LISTED)
    assert listed.choices["R"] == [2.0, 2.5, 3.0] and listed.ties == {"rp": ("rj", 2.0)}
    objective = Objective(listed)
    search = optuna.create_study(directions=objective.directions, sampler=optuna.samplers.RandomSampler(seed=1))
    search.optimize(objective, n_trials=20)
    columns = [objective.design(trial) for trial in search.trials]
    problem = StudyProblem(listed)
    x = np.random.default_rng(0).uniform(problem.xl, problem.xu, (20, problem.n_var))
    together = problem.designs(x)
    columns += [{name: together[name][row] for name in ("R", "rj", "rp")} for row in range(20)]
    for design in columns:
        assert design["R"] in listed.choices["R"] and design["rj"] in listed.choices["rj"]
        assert design["rp"] == 2.0 * design["rj"]
    assert len({design["R"] for design in columns}) == 3
    # What a search of the program proposes obeys the same lists.
    found = listed.optimize(seed=1, evaluations=60).designs
    assert set(found["R"]) <= set(listed.choices["R"]) and np.allclose(found["rp"], 2.0 * found["rj"])


READINGS = {"as it is": "", "aluminium": "[material]\nyoungs_modulus_pa = 7e10\nshear_modulus_pa = 2.6e10\ndensity_kg_per_m3 = 2700\n"}


def test_dask_gives_the_results_of_this_machine_though_a_worker_is_killed(study):
    distributed = pytest.importorskip("distributed")
    from kinefront import dask

    random = np.random.default_rng(2)
    columns = {name: random.uniform(low, high, 1500) for name, (low, high) in study.bounds.items()}
    columns["architecture"] = random.choice(study.architectures, 1500)
    local = study.evaluate(columns)
    local_sweep = sweeps.sweep(study, READINGS, [1, 2], evaluations=150, threads=1)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            victim = next(iter(client.scheduler_info()["workers"]))
            client.submit(_end, workers=[victim], allow_other_workers=False, retries=0, pure=False)
            table = dask.evaluate(study, columns, client, chunk=100)
            found = dask.sweep(study, READINGS, [1, 2], client, evaluations=150)
            sensitivity = dask.sweep(study, study.sensitivity(90), [None], client)
    for name in local.columns:
        mine, theirs = np.asarray(local[name]), np.asarray(table[name])
        assert np.array_equal(mine, theirs, equal_nan=mine.dtype == float), name
    local_sensitivity = sweeps.sweep(study, study.sensitivity(90), [None], threads=1)
    readings = {search.reading for search in sensitivity}
    assert {"study as given, 3-PRR", "K_act × 10, 3-RRR", "seed + 1, 3-RPR"} <= readings and len(readings) == len(sensitivity)
    for mine, theirs in zip([*local_sweep, *local_sensitivity], [*found, *sensitivity], strict=True):
        assert (mine.reading, mine.seed) == (theirs.reading, theirs.seed)
        assert mine.hypervolume == theirs.hypervolume
        assert np.array_equal(mine.front["mass_kg"], theirs.front["mass_kg"])


def _end():
    import os
    import time

    time.sleep(1.0)
    os._exit(1)


def test_a_design_is_logged_into_a_recording(study, tmp_path):
    rr = pytest.importorskip("rerun")
    from kinefront.rerun import log_design

    recording = rr.RecordingStream("mine")
    recording.save(tmp_path / "mine.rrd")
    log_design("robot", study.design("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"), recording=recording)
    recording.flush()
    del recording
    assert (tmp_path / "mine.rrd").stat().st_size > 10_000


@pytest.mark.parametrize("name", ["front.py", "with_pymoo.py", "with_optuna.py", "with_dask.py"])
def test_the_examples_run(name, tmp_path, monkeypatch):
    for module in {"front.py": ["matplotlib"], "with_pymoo.py": ["pymoo"], "with_optuna.py": ["optuna"], "with_dask.py": ["distributed"]}[name]:
        pytest.importorskip(module)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [name, "--quick"])
    runpy.run_path(str(EXAMPLES / name), run_name="__main__")
    assert name != "front.py" or (tmp_path / "front.png").stat().st_size > 5000
