"""The model from Python: designs in many forms, poses, exports and errors. Values are those of the program and of independent solvers."""

import json
import pickle
import threading
from pathlib import Path

import numpy as np
import pytest

import kinefront
from kinefront import Study

ROOT = Path(__file__).resolve().parents[2]
FIXTURE = ROOT / "crates/testkit/fixtures/run"
PAPER_DESIGN = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056"


@pytest.fixture(scope="module")
def study():
    return Study.paper()


def random_designs(study, count, seed=0):
    random = np.random.default_rng(seed)
    columns = {name: random.uniform(low, high, count) for name, (low, high) in study.bounds.items()}
    columns["architecture"] = random.choice(study.architectures, count)
    return columns


def test_the_version_is_that_of_the_program():
    manifest = (ROOT / "Cargo.toml").read_text()
    assert f'version = "{kinefront.__version__}"' in manifest


def test_all_forms_of_designs_give_the_same_bits(study):
    pandas = pytest.importorskip("pandas")
    columns = random_designs(study, 40)
    table = study.evaluate(columns)
    assert len(table) == 40 and table["mass_kg"].shape == (40,)
    designs = study.designs(columns)
    forms = [
        designs,
        [str(design) for design in designs],
        table,
        pandas.DataFrame(columns),
        {name: values.tolist() for name, values in columns.items()},
        table.to_numpy(),
    ]
    for form in forms:
        other = study.evaluate(form)
        for name in table.columns:
            same = np.array_equal(np.asarray(table[name]), np.asarray(other[name]), equal_nan=np.asarray(table[name]).dtype == float)
            assert same, name
    one = study.evaluate(columns, threads=1)
    assert np.array_equal(one["mass_kg"], table["mass_kg"]) and np.array_equal(one["workspace_radius_m"], table["workspace_radius_m"])


def test_a_single_value_stands_for_all_designs(study):
    table = study.evaluate({"architecture": "3-RPR", "R": np.linspace(1, 2, 5), "r": 0.4, "Lb": 2.0, "rj": 0.03, "rp": 0.03})
    assert table["architecture"] == ["3-RPR"] * 5
    assert np.all(table["r"] == 0.4) and np.all(np.diff(table["R"]) > 0)


def test_evaluations_are_those_of_the_run_in_the_fixture():
    run = kinefront.Run.open(FIXTURE)
    designs = run.designs
    again = run.study.evaluate(designs)
    # The run in the fixture was made by an earlier build, which stated the margins of designs without a workspace at other poses.
    feasible = np.asarray(designs["feasible"])
    assert 50 < feasible.sum() < len(designs)
    for name, rows, offset in [
        ("mass_kg", ..., 0.0),
        ("workspace_radius_m", ..., 0.0),
        ("violation", ..., 0.0),
        # A margin is a ratio less 1: the ratio has the precision, also where the margin is almost 0.
        ("margin_g4", feasible, 1.0),
        ("value_g3", feasible, 0.0),
    ]:
        found, expected = (offset + np.asarray(table[name])[rows] for table in (again, designs))
        assert np.allclose(found, expected, rtol=1e-13, atol=0), name
    front = run.front
    assert len(front) > 3 and list(np.sort(front["workspace_radius_m"])) == list(front["workspace_radius_m"])
    assert {"lightest", "knee", "largest"} <= set(front["mark"])
    assert run.report["evaluations"] == len(designs)
    assert "run" in str(run.path)


def test_poses_agree_with_the_identities_of_statics(study):
    design = study.design(PAPER_DESIGN)
    random = np.random.default_rng(1)
    poses = np.column_stack([random.uniform(-0.4, 0.4, (200, 2)), random.uniform(-0.1, 0.1, 200)])
    found = design.poses(poses)
    reached = found["reachable"]
    assert reached.sum() > 100
    stiffness = found["K"][reached]
    assert np.allclose(stiffness, np.swapaxes(stiffness, 1, 2), rtol=1e-9, atol=1e-3)
    assert np.all(np.linalg.eigvalsh(stiffness) > 0)
    # The distance from B to C is the length of the link, and that from P to C the radius of the platform.
    link = np.linalg.norm(found["C"][reached] - found["B"][reached], axis=2)
    assert np.allclose(link, design.values["Lb"], atol=1e-12)
    arm = np.linalg.norm(found["C"][reached] - poses[reached, None, :2], axis=2)
    assert np.allclose(arm, design.values["r"], atol=1e-12)
    # k_xy is the smaller eigenvalue of the planar block of the stiffness of the positions, by the definition of the paper's study.
    names = found["constraints"]
    assert found["margins"].shape == (200, len(names)) and names[0] == "g1"
    threshold = 0.1
    kappa = found["margins"][reached][:, names.index("g3")]
    assert np.allclose(kappa, (found["kappa"][reached] - threshold) / threshold, rtol=1e-12)
    far = design.poses(np.array([[9.0, 0.0, 0.0]]))
    assert not far["reachable"][0] and np.isnan(far["K"]).all() and np.isnan(far["margins"]).all()
    assert np.array_equal(study.poses(PAPER_DESIGN, poses)["kappa"], found["kappa"], equal_nan=True)


def test_exports_are_those_of_the_program(study):
    design = study.design(PAPER_DESIGN)
    assert design.export("mjcf").lstrip().startswith("<")
    assert design.export("gltf")[:4] == b"glTF"
    assert json.loads(design.export("json"))
    assert design.export("step").startswith("ISO-10303-21;")
    with pytest.raises(kinefront.InputError, match="there is no format `iges`; expected one of gltf, mjcf"):
        design.export("iges")


def test_tables_travel_and_become_frames(study):
    table = study.evaluate(random_designs(study, 30, seed=3))
    again = pickle.loads(pickle.dumps(table))
    assert again.columns == table.columns and again.units == table.units and len(again) == 30
    assert np.array_equal(again["margin_g4"], table["margin_g4"], equal_nan=True)
    joined = type(table).concat([table, again])
    assert len(joined) == 60 and joined["architecture"] == table["architecture"] * 2
    assert pickle.loads(pickle.dumps(study)) == study
    polars, pandas, arrow = (pytest.importorskip(name) for name in ["polars", "pandas", "pyarrow"])
    as_polars, as_pandas, as_arrow = table.to_polars(), table.to_pandas(), table.to_arrow()
    assert isinstance(as_polars, polars.DataFrame) and isinstance(as_pandas, pandas.DataFrame)
    assert as_polars.columns == table.columns == list(as_pandas.columns) == as_arrow.column_names
    assert as_polars["mass_kg"].to_list() == table["mass_kg"].tolist() == as_pandas["mass_kg"].tolist()
    assert as_polars["phi_deg"].null_count() == np.isnan(table["phi_deg"]).sum() == as_arrow["phi_deg"].null_count
    assert as_arrow["feasible"].to_pylist() == table["feasible"].tolist()
    assert arrow.table(table).num_rows == 30


def test_errors_have_the_words_of_the_program(study):
    with pytest.raises(kinefront.StudyError) as caught:
        Study.from_toml("[bounds]\nR_m = [2.0, 1.0]\n")
    assert "bounds.R_m" in str(caught.value) and caught.value.faults[0][0] == "bounds.R_m"
    with pytest.raises(kinefront.StudyError, match="neither a study file nor a built-in study named `papr`"):
        Study.read("papr")
    with pytest.raises(kinefront.DesignError, match="4-PRR"):
        study.design("4-PRR R=1")
    with pytest.raises(kinefront.DesignError, match="row 1: "):
        study.evaluate({"architecture": "3-PRR", "R": [1.0, -1.0], "r": 1.0, "Lb": 1.0, "rj": 0.1, "rp": 0.1})
    with pytest.raises(kinefront.InputError, match="the column `r` has 2 values; expected 3"):
        study.evaluate({"architecture": "3-PRR", "R": [1.0] * 3, "r": [1.0] * 2, "Lb": 1.0, "rj": 0.1, "rp": 0.1})
    with pytest.raises(kinefront.InputError, match="no column `architecture`"):
        study.evaluate({"R": 1.0, "r": 1.0, "Lb": 1.0, "rj": 0.1, "rp": 0.1})
    with pytest.raises(kinefront.RunError, match="run"):
        kinefront.Run.open(ROOT / "docs")
    with pytest.raises(kinefront.InputError, match="expected `reference` or `fine`"):
        study.evaluate(PAPER_DESIGN, grid="coarse")
    with pytest.raises(KeyError, match="there is no column `mass`"):
        study.evaluate(PAPER_DESIGN)["mass"]
    with pytest.raises(TypeError):
        study.evaluate(3.0)
    assert issubclass(kinefront.StudyError, ValueError) and issubclass(kinefront.FileError, OSError)


def test_settings_are_replaced(study):
    other = study.replace("[material]\nyoungs_modulus_pa = 7e10\n[optimizer]\nseed = 9\n")
    assert other != study and other.optimizer["seed"] == 9
    heavy, soft = (found.evaluate(PAPER_DESIGN) for found in (study, other))
    assert heavy["mass_kg"] == soft["mass_kg"]
    assert Study.from_toml(study.to_toml()) == study
    with pytest.raises(kinefront.StudyError, match="youngs"):
        study.replace("[material]\nyoungs = 1")


def test_other_threads_run_during_an_evaluation(study):
    done, count = threading.Event(), 0

    def turn():
        nonlocal count
        while not done.is_set():
            count += 1

    thread = threading.Thread(target=turn)
    thread.start()
    before = count
    study.evaluate(random_designs(study, 600), threads=1)
    during = count - before
    done.set()
    thread.join()
    assert during > 1000


@pytest.mark.parametrize(("given", "meant"), [("alpha", "alpha_deg"), ("L_A", "La"), ("LB", "Lb"), ("R_m", "R")])
def test_a_misspelt_column_is_refused(study, given, meant):
    columns = {"architecture": ["3-PRR"], "R": [1.4], "r": [0.3], "Lb": [0.6], "rj": [0.03], "rp": [0.03]}
    known = study.evaluate({**columns, "note": ["a column of no concern"]})
    assert len(known) == 1
    columns.pop(meant, None)
    with pytest.raises(kinefront.InputError, match=f"`{given}` is not known; did you mean `{meant}`"):
        study.evaluate({**columns, given: [1.0]})
