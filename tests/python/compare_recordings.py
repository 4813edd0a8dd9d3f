"""Compare the contents of two recordings, row by row, however they are divided into chunks."""

import sys

from rerun.experimental import RrdReader


def contents(path):
    """Return the rows of each entity: times and components, without what belongs to the file."""
    rows = {}
    for chunk in RrdReader(path).stream():
        batch = chunk.to_record_batch()
        for row in batch.to_pylist():
            times = tuple((name, row.get(name)) for name in chunk.timeline_names)
            parts = tuple(
                (name, repr(value))
                for name, value in sorted(row.items())
                if value is not None
                and name not in chunk.timeline_names
                and name not in ("rerun.controls.RowId", "RecordingInfo:start_time")
            )
            rows.setdefault(str(chunk.entity_path), []).append((times, parts))
    return {entity: sorted(found, key=repr) for entity, found in rows.items()}


first, second = (contents(path) for path in sys.argv[1:3])
assert first.keys() == second.keys(), first.keys() ^ second.keys()
count = 0
for entity in first:
    assert len(first[entity]) == len(second[entity]), entity
    for a, b in zip(first[entity], second[entity]):
        assert a == b, f"{entity} differs at {a[0]}"
        count += 1
assert count > 1000, count
print(f"{count} rows of {len(first)} entities are alike")
