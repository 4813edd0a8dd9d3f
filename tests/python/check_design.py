"""Check a recording of one design (`kinefront show`), with the Rerun package's own verifier and reader.

    check_design.py FILE.rrd

Prints one JSON object: poses of the tour, vertices of the heatmap shown first, bars of the legs, views of the layout,
and the card.
"""

import json
import sys
from pathlib import Path

import numpy as np
from rrd import open_verified, tables_of

path = Path(sys.argv[1])
reader = open_verified(path)
tables = tables_of(reader.stream())

fields = ["inverse_condition", "k_xy", "k_z", "k_phi_z", "displacement", "worst_margin", "clearance"]
wanted = ["/card", "/configuration/axes/lines", "/configuration/cylinder/outline", "/design/workspace/outline"]
wanted += ["/design/limits/poses", "/design/ellipsoids/stiffness/bodies", "/design/ellipsoids/displacement/bodies"]
wanted += [f"/design/heatmap/{field}/field" for field in fields] + [f"/legend/{field}/bar" for field in fields]
# The layer at the home orientation; other layers may have no reachable pose.
wanted += ["/configuration/layers/2/edge"]
wanted += ["/design/proof/boxes", "/design/proof/depth", "/design/proof/violation", "/configuration/proof/boxes"]
missing = [entity for entity in wanted if entity not in tables]
assert not missing, missing
# Entities that do not move are static: they have no timeline.
for entity in wanted:
    assert "tour" not in tables[entity].schema.names, entity

moving = ["legs", "platform", "joints/passive", "joints/actuated", "base", "frames", "labels", "clearance/line"]
steps = None
for name in moving:
    table = tables[f"/design/manipulator/{name}"].sort_by("tour")
    times = table["tour"].to_pylist()
    assert times == list(range(len(times))), f"{name}: {times[:5]}"
    assert steps in (None, len(times)), f"{name} has {len(times)} poses, not {steps}"
    steps = len(times)

# Bars keep their lengths while the platform moves along the tour.
legs = tables["/design/manipulator/legs"].sort_by("tour")["Cylinders3D:lengths"].to_pylist()
platform = np.array(tables["/design/manipulator/platform"]["Cylinders3D:lengths"].to_pylist())
assert np.allclose(platform, platform[0, 0], rtol=1e-6)

# The nearest pair of members is labelled with its distance at each pose.
words = tables["/design/manipulator/clearance/distance"]["Points3D:labels"].to_pylist()
assert len(words) == steps and all(len(row) == 1 and row[0].endswith(" mm") for row in words), words[:3]

mesh = tables["/design/heatmap/inverse_condition/field"]
vertices = np.array(mesh["Mesh3D:vertex_positions"].to_pylist()[0])
triangles = np.array(mesh["Mesh3D:triangle_indices"].to_pylist()[0])
colors = mesh["Mesh3D:vertex_colors"].to_pylist()[0]
assert len(colors) == len(vertices) and triangles.max() < len(vertices) and np.isfinite(vertices).all()

views = {}
for chunk in reader.stream(store=reader.blueprints()[0]):
    for name, values in chunk.to_record_batch().to_pydict().items():
        if name == "ViewBlueprint:class_identifier":
            views[values[0][0]] = views.get(values[0][0], 0) + 1

print(
    json.dumps(
        {
            "poses": steps,
            "vertices": len(vertices),
            "leg_bars": len(legs[0]),
            "views": views,
            "card": tables["/card"]["TextDocument:text"].to_pylist()[0][0],
        }
    )
)
