"""Check the motion in a recording of one design (`kinefront show`) against the rows of `kinefront task --csv`, with the Rerun package's own
verifier and reader.

    check_motion.py FILE.rrd MOTION.csv

Prints one JSON object: rows of the curves, poses of the manipulator, and the largest difference from the table.
"""

import csv
import json
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from rrd import open_verified, tables_of

path, table_path = map(Path, sys.argv[1:])
entities = tables_of(open_verified(path).stream())

with open(table_path, encoding="utf-8") as file:
    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
times = np.array([row["t_s"] for row in rows])


def moving(entity):
    """Return the rows of an entity on the timeline of the motion, in their order."""
    rows = entities[entity]
    return rows.filter(pc.is_valid(rows["time"])).sort_by("time")


columns = {"position": "q", "speed": "qd", "acceleration": "qdd", "force": "tau", "power": "p"}
off = 0.0
for curve, column in columns.items():
    for leg in (1, 2, 3):
        table = moving(f"/motion/{curve}/leg{leg}")
        at = np.array(table["time"].cast(pa.int64()).to_pylist()) * 1e-9
        found = np.array([value[0] for value in table["Scalars:scalars"].to_pylist()])
        wanted = np.array([row[f"{column}{leg}"] for row in rows])
        assert len(found) == len(wanted), f"{curve} has {len(found)} rows, not {len(wanted)}"
        assert np.allclose(at, times, atol=2e-9)
        off = max(off, float(np.abs(found - wanted).max() / max(np.abs(wanted).max(), 1e-12)))

legs = moving("/design/manipulator/legs")
# Each moment of the motion has one state of the manipulator, within the cycle.
at = np.array(legs["time"].cast(pa.int64()).to_pylist()) * 1e-9
assert at[0] == 0.0 and abs(at[-1] - times[-1]) < 2e-9 and (np.diff(at) > 0.0).all(), at

print(json.dumps({"rows": len(rows), "poses": len(at), "off": off, "has_path": "/design/path" in entities}))
