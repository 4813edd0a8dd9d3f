"""Reads a plan view back with ezdxf, a front's Parquet with pyarrow, and the animation of a glTF without a library.

Usage: read_exports.py DESIGN.dxf FRONT.parquet FRONT.csv DESIGN.glb DESIGN.json
"""

import json
import math
import struct
import sys

import ezdxf
import pyarrow.csv
import pyarrow.parquet


def animation(glb_path, design_path):
    """Return the largest distances, over the whole animation, of the platform from the poses of the tour and of the
    ends of the legs from the joints of the platform."""
    with open(design_path, encoding="utf-8") as file:
        design = json.load(file)
    with open(glb_path, "rb") as file:
        glb = file.read()
    length = struct.unpack_from("<I", glb, 12)[0]
    scene, numbers = json.loads(glb[20 : 20 + length]), glb[20 + length + 8 :]

    def read(accessor):
        accessor = scene["accessors"][accessor]
        view = scene["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        flat = struct.unpack_from(f"<{width * accessor['count']}f", numbers, view["byteOffset"])
        return [flat[k : k + width] for k in range(0, len(flat), width)]

    moved = {}
    animation = scene["animations"][0]
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        name = scene["nodes"][channel["target"]["node"]]["name"]
        moved.setdefault(name, {})[channel["target"]["path"]] = read(sampler["output"])

    def place(name, step, point):
        x, y, _ = moved[name]["translation"][step]
        qx, qy, qz, qw = moved[name]["rotation"][step]
        assert qx == qy == 0.0 and abs(qz * qz + qw * qw - 1.0) < 1e-6
        angle = 2.0 * math.atan2(qz, qw)
        c, s = math.cos(angle), math.sin(angle)
        return x + c * point[0] - s * point[1], y + s * point[0] + c * point[1]

    from_tour = gap = 0.0
    for step, pose in enumerate(design["tour"]):
        from_tour = max(from_tour, math.dist(place("platform", step, (0.0, 0.0)), (pose["x_m"], pose["y_m"])))
        for closure in design["closures"]:
            on_leg = place(closure["leg_body"], step, closure["on_leg_m"])
            gap = max(gap, math.dist(on_leg, place("platform", step, closure["on_platform_m"])))
    return {"bodies": len(moved), "steps": len(design["tour"]), "from_tour_m": from_tour, "gap_m": gap}


def main():
    drawing_path, parquet_path, csv_path, glb_path, design_path = sys.argv[1:]
    drawing = ezdxf.readfile(drawing_path)
    audit = drawing.audit()
    space = drawing.modelspace()
    bars = []
    for outline in space.query('POLYLINE[layer=="LEGS"]'):
        assert outline.is_closed
        a, b, c, _ = [(point.x, point.y) for point in outline.points()]
        bars.append([((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5, ((c[0] - b[0]) ** 2 + (c[1] - b[1]) ** 2) ** 0.5])
    table = pyarrow.parquet.read_table(parquet_path)
    text = pyarrow.csv.read_csv(csv_path).select(table.column_names)
    differing = [
        name
        for name in table.column_names
        # A missing value is an empty text in a CSV file.
        if [value or None if isinstance(value, str) else value for value in text[name].to_pylist()]
        != table[name].to_pylist()
    ]
    print(
        json.dumps(
            {
                "faults": len(audit.errors) + len(audit.fixes),
                "release": drawing.acad_release,
                "notes": [text.dxf.text for text in space.query('TEXT[layer=="TITLE_BLOCK"]')],
                "layers": sorted(layer.dxf.name for layer in drawing.layers),
                "legs_mm": bars,
                "workspace_mm": [circle.dxf.radius for circle in space.query('CIRCLE[layer=="WORKSPACE"]')],
                "labels": sorted(label.dxf.text for label in space.query('TEXT[layer=="TEXT"]')),
                "dimensions": [
                    {
                        "override": dimension.dxf.get("text", ""),
                        "text": [entity.dxf.text for entity in dimension.get_geometry_block() if entity.dxftype() == "TEXT"][0],
                        "measured": dimension.dxf.defpoint2.distance(dimension.dxf.defpoint3),
                        "shown": sorted(entity.dxftype() for entity in dimension.get_geometry_block()),
                        "style": dimension.dxf.dimstyle in drawing.dimstyles,
                    }
                    for dimension in space.query("DIMENSION")
                ],
                "rows": table.num_rows,
                "types": {name: str(table.schema.field(name).type) for name in table.column_names},
                "differing": differing,
                "animation": animation(glb_path, design_path),
            }
        )
    )


if __name__ == "__main__":
    main()
