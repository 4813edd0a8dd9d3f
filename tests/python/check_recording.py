"""Check RUN/recording.rrd against RUN/designs.csv, with the Rerun package's own verifier and reader."""

import csv
import json
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from rrd import open_verified, tables_of

run = Path(sys.argv[1])
path = run / "recording.rrd"

reader = open_verified(path)


def table(entity):
    found = tables_of(reader.stream().filter(content=entity))
    assert entity in found, f"no rows at {entity}"
    return found[entity]


def column(rows, name):
    """Return one value per row, None if the row has none."""
    return [None if not cell else cell[0] for cell in rows[name].to_pylist()]


with open(run / "designs.csv", newline="") as file:
    designs = list(csv.DictReader(file))

rows = table("/designs")
assert rows.num_rows == len(designs), f"{rows.num_rows} rows for {len(designs)} designs"
order = np.argsort(rows["evaluation"].to_numpy(), kind="stable")
rows = rows.take(pa.array(order))
assert rows["evaluation"].to_pylist() == [int(d["id"]) for d in designs]
assert rows["generation"].to_pylist() == [int(d["generation"]) for d in designs]
checked = 0
for name in designs[0]:
    if name in ("id", "generation"):
        continue
    recorded = column(rows, name)
    for value, design in zip(recorded, designs):
        text = design[name]
        if isinstance(value, bool):
            assert str(value).lower() == text
        elif isinstance(value, float):
            assert float(text) == value, f"{name}: {value} for {text}"
        else:
            assert (value or "") == text, f"{name}: {value!r} for {text!r}"
        checked += 1

report = json.loads((run / "run.json").read_text())
history = report["history"]
for entity, key in [("/run/hypervolume", "hypervolume"), ("/run/front_size", "front_size")]:
    curve = table(entity)
    curve = curve.filter(pc.is_valid(curve["generation"])).sort_by("generation")
    assert curve["generation"].to_pylist() == [g["generation"] for g in history]
    assert column(curve, "Scalars:scalars") == [float(g[key]) for g in history]

# Every feasible design is a point of the scatter: at (log10 mass, R_w), at the first two of other objectives, or, with one
# objective, at its value over the number of evaluations. Masses and stiffness are in decades.
def coordinate(design, key):
    value = float(design[{"k_xy_n_per_m": "value_g4"}.get(key, key)])
    return np.log10(value) if key.endswith(("_kg", "_n_per_m")) else value


def place(design):
    keys = [objective.get("minimize") or objective["maximize"] for objective in report.get("objectives", [])]
    if not keys:
        return coordinate(design, "mass_kg"), coordinate(design, "workspace_radius_m")
    if len(keys) == 1:
        return int(design["id"]) + 1, coordinate(design, keys[0])
    return coordinate(design, keys[0]), coordinate(design, keys[1])


wanted = sorted(tuple(float(np.float32(at)) for at in place(d)) for d in designs if d["feasible"] == "true")
points = []
for architecture in report["architectures"]:
    try:
        cloud = table(f"/scatter/plot/designs/{architecture}")
    except AssertionError:
        continue
    points += [tuple(point) for cell in cloud["Points2D:positions"].to_pylist() for point in cell]
assert len(points) == len(wanted), f"{len(points)} points for {len(wanted)} feasible designs"
assert np.allclose(sorted(points), wanted, atol=1e-6)

# The timeline `front` has a step for every verified design, in order; the knee is recorded again at the end of the run.
# A run that was interrupted has no front.
front = []
if (run / "front.csv").exists():
    with open(run / "front.csv", newline="") as file:
        front = list(csv.DictReader(file))
assert bool(front) == (report["outcome"] != "interrupted")
for entity in () if not front else ("/card", "/design/manipulator/legs", "/design/manipulator/joints/sliders", "/design/limits/poses",
               "/design/heatmap/inverse_condition/field", "/design/workspace/outline", "/design/ellipsoids/stiffness/bodies",
               "/configuration/cylinder/outline", "/scatter/plot/front/selected"):
    rows_there = table(entity)
    steps = [step for step in rows_there["front"].to_pylist() if step is not None]
    assert sorted(steps) == list(range(len(front))), f"{entity}: {len(steps)} steps for {len(front)} designs"
    ends = [end for end in rows_there["generation"].to_pylist() if end is not None]
    assert ends == [history[-1]["generation"]], f"{entity}: {ends}"
if front:
    cards = table("/card").filter(pc.is_valid(table("/card")["front"])).sort_by("front")
    for card, design in zip(cards["TextDocument:text"].to_pylist(), front):
        assert card[0].startswith(f"# #{design['id']}, "), card[0][:40]
        assert f"R_w = {float(design['workspace_radius_m']):.4f} m" in card[0]
    along = table("/along_front/R_w").filter(pc.is_valid(table("/along_front/R_w")["front"])).sort_by("front")
    assert column(along, "Scalars:scalars") == [float(design["workspace_radius_m"]) for design in front]

study = table("/study")["TextDocument:text"].to_pylist()[0][0]
assert (run / "study.toml").read_text() in study
assert reader.recordings()[0].application_id == "kinefront"

views = {}
for chunk in reader.stream(store=reader.blueprints()[0]):
    batch = chunk.to_record_batch().to_pydict()
    for name, values in batch.items():
        if name == "ViewBlueprint:class_identifier":
            views.setdefault(values[0][0], []).append(str(chunk.entity_path))
assert {"2D", "3D", "TimeSeries", "TextDocument", "Dataframe"} <= set(views), views
print(f"{rows.num_rows} rows and {checked} values agree; {sum(map(len, views.values()))} views")
