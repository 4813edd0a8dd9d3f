"""Check the motion in a recording of one design (`kinefront show`) against the rows of `kinefront task --csv`, with the Rerun package's own
verifier and reader.

    check_motion.py FILE.rrd MOTION.csv

Prints one JSON object: rows of the curves, poses of the manipulator, and the largest difference from the table.
"""

import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import rerun
from rerun.experimental import RrdReader

path, table_path = map(Path, sys.argv[1:])
command = Path(rerun.__file__).parent.parent / "rerun_cli" / "rerun"
verified = subprocess.run([str(command), "rrd", "verify", str(path)], capture_output=True, text=True)
assert verified.returncode == 0 and "1 file verified without error" in verified.stderr, verified.stderr

reader = RrdReader(str(path))
entities = {}
for chunk in reader.stream():
    batch = chunk.to_record_batch()
    entities.setdefault(str(chunk.entity_path), []).append(pa.Table.from_batches([batch.replace_schema_metadata(None)]))

with open(table_path, encoding="utf-8") as file:
    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
times = np.array([row["t_s"] for row in rows])


def moving(entity):
    parts = [part for part in entities[entity] if "time" in part.schema.names]
    return pa.concat_tables(parts, promote_options="default").sort_by("time")


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
