"""Check a recording of prices along a front (`kinefront prices TABLE --record`) against the command's JSON, with the Rerun package's own
verifier and reader.

    check_prices.py FILE.rrd ALONG.json
"""

import json
import sys
from pathlib import Path

from rrd import open_verified, tables_of

path = Path(sys.argv[1])
along = json.loads(Path(sys.argv[2]).read_text())
reader = open_verified(path)
tables = tables_of(reader.stream())

# A step is a design with prices, in the order of the quantity along the front, whatever its architecture.
steps = [(design["at"], front, design) for front in along for design in front["designs"]]
steps.sort(key=lambda step: step[0])
cards = tables["/card"].sort_by("front")
assert cards["front"].to_pylist() == list(range(len(steps)))
for (_, _, design), [card] in zip(steps, cards["TextDocument:text"].to_pylist()):
    assert f"#{design['id']}," in card, card
assert len(tables["/design/manipulator/legs"]) == len(steps)

summary = tables["/summary"]["TextDocument:text"].to_pylist()[0][0]
curves = 0
for front in along:
    for sentence in front["sentences"]:
        assert sentence in summary, sentence
    own = [step for step, (_, other, _) in enumerate(steps) if other is front]
    for entity in [name for name in tables if name.startswith(f"/prices/{front['architecture']}/")]:
        parameter = entity.rsplit("/", 1)[1].replace("\\", "")
        rows = tables[entity].filter(tables[entity]["Scalars:scalars"].is_valid()).sort_by("front")
        assert rows["front"].to_pylist() == own, entity
        for step, [value] in zip(own, rows["Scalars:scalars"].to_pylist()):
            prices = steps[step][2]["drivers"]["prices"]
            expected = next((price["price"] for price in prices if price["parameter"] == parameter), 0.0)
            assert value == expected, (entity, step, value, expected)
        curves += 1

plots = 0
for chunk in reader.stream(store=reader.blueprints()[0]):
    for name, values in chunk.to_record_batch().to_pydict().items():
        plots += name == "ViewBlueprint:class_identifier" and values[0][0] == "TimeSeries"

print(json.dumps({"steps": len(steps), "curves": curves, "plots": plots}))
