"""Searches from Python: the result of the program, progress, interruption, and run folders."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import kinefront
from kinefront import Study


@pytest.fixture(scope="module")
def study():
    return Study.paper().replace("[workspace]\ncertify = false\n")


def test_a_search_tells_its_progress_and_gives_one_result(study, tmp_path):
    seen = []
    run = study.optimize(seed=3, evaluations=240, callback=seen.append, out=tmp_path / "run")
    assert [state.generation for state in seen if state.phase == "search"][0] == 1
    assert max(state.evaluations for state in seen if state.phase == "search") == 240
    assert any(state.phase == "verification" for state in seen)
    assert len(run.designs) == 240 and len(run.front) > 3
    again = study.optimize(seed=3, evaluations=240, threads=1)
    for name in ["mass_kg", "workspace_radius_m"]:
        assert np.array_equal(run.designs[name], again.designs[name])
        assert np.array_equal(run.front[name], again.front[name])
    opened = kinefront.Run.open(tmp_path / "run")
    assert np.array_equal(opened.designs["mass_kg"], run.designs["mass_kg"])
    assert np.array_equal(opened.front["workspace_radius_m"], run.front["workspace_radius_m"])
    assert opened.front["mark"] == run.front["mark"]
    assert opened.study.optimizer["seed"] == 3
    with pytest.raises(kinefront.FileError, match="run"):
        study.optimize(seed=3, evaluations=240, out=tmp_path / "run")


def test_a_callback_ends_a_search_and_its_exceptions_arrive(study):
    run = study.optimize(evaluations=100_000, callback=lambda state: state.evaluations < 100)
    assert 100 <= len(run.designs) < 1000 and run.report["outcome"] == "stopped"

    def fail(_):
        raise ZeroDivisionError("of the callback")

    with pytest.raises(ZeroDivisionError, match="of the callback"):
        study.optimize(evaluations=100_000, callback=fail)


def test_wrong_settings_are_told(study):
    with pytest.raises(kinefront.InputError, match="`optimizer.evaluations`"):
        study.optimize(evaluations=0)
    with pytest.raises(kinefront.InputError, match="no algorithm `simplex`; expected one of front-de"):
        study.optimize(algorithm="simplex")


@pytest.mark.skipif(os.name != "posix", reason="signals are those of POSIX")
def test_ctrl_c_interrupts_a_search_whose_folder_can_be_resumed(tmp_path):
    folder = tmp_path / "run"
    code = f"""
import kinefront, sys
study = kinefront.Study.paper()
print("ready", flush=True)
try:
    study.optimize(evaluations=1_000_000, out={str(folder)!r})
except KeyboardInterrupt:
    sys.exit(42)
"""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert process.stdout.readline().strip() == b"ready"
    time.sleep(1.5)
    since = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=20) == 42
    assert time.monotonic() - since < 5
    run = kinefront.Run.open(folder)
    assert len(run.designs) > 0 and run.report["outcome"] == "interrupted"
    with pytest.raises(kinefront.RunError, match="resume"):
        run.front


def test_searches_in_threads_do_not_disturb_each_other(study):
    found = {}

    def perform(seed):
        found[seed] = study.optimize(seed=seed, evaluations=120, threads=1).designs["mass_kg"]

    threads = [threading.Thread(target=perform, args=(seed,)) for seed in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert np.array_equal(found[1], study.optimize(seed=1, evaluations=120).designs["mass_kg"])
    assert not np.array_equal(found[1], found[2])
