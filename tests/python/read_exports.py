"""Reads a plan view back with ezdxf and a front's Parquet with pyarrow.

Usage: read_exports.py DESIGN.dxf FRONT.parquet FRONT.csv
"""

import json
import sys

import ezdxf
import pyarrow.csv
import pyarrow.parquet


def main():
    drawing_path, parquet_path, csv_path = sys.argv[1:]
    drawing = ezdxf.readfile(drawing_path)
    space = drawing.modelspace()
    bars = []
    for outline in space.query('LWPOLYLINE[layer=="LEGS"]'):
        a, b, c, _ = [point[:2] for point in outline.get_points()]
        bars.append([((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5, ((c[0] - b[0]) ** 2 + (c[1] - b[1]) ** 2) ** 0.5])
    table = pyarrow.parquet.read_table(parquet_path)
    text = pyarrow.csv.read_csv(csv_path).select(table.column_names)
    differing = [
        name
        for name in table.column_names
        # What is missing is an empty text in a CSV.
        if [value or None if isinstance(value, str) else value for value in text[name].to_pylist()]
        != table[name].to_pylist()
    ]
    print(
        json.dumps(
            {
                "errors": len(drawing.audit().errors),
                "millimetres": drawing.units == ezdxf.units.MM,
                "layers": sorted(layer.dxf.name for layer in drawing.layers),
                "legs_mm": bars,
                "workspace_mm": [circle.dxf.radius for circle in space.query('CIRCLE[layer=="WORKSPACE"]')],
                "labels": sorted(label.dxf.text for label in space.query("TEXT") if len(label.dxf.text) <= 2),
                "rows": table.num_rows,
                "types": {name: str(table.schema.field(name).type) for name in table.column_names},
                "differing": differing,
            }
        )
    )


if __name__ == "__main__":
    main()
