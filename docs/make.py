"""Writes the tables of the documents that follow from commands: make.py [--program PATH] [--check] [NAME ...].

A table stands between `<!-- make.py NAME -->` and `<!-- end -->` in a document of this folder. Without names all are written. With
--check nothing is written, and tables that are not current are an error.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent

# Designs that the paper prints, with its mass in kg and its workspace radius in m.
PUBLISHED = [
    ("ID-I", "3-PRR R=1.412 r=0.319 Lb=0.620 rj=0.026 rp=0.023", "44.5", "0.110"),
    ("ID-II", "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056", "484.8", "1.207"),
    ("ID-III", "3-PRR R=3.872 r=1.947 Lb=1.977 rj=0.039 rp=0.096", "1545.6", "1.609"),
]


def table(header, rows):
    right = "".join("---:|" for _ in header[1:])
    lines = ["| " + " | ".join(row) + " |" for row in [header, *rows]]
    return "\n".join([lines[0], "|---|" + right, *lines[1:]])


def published(kinefront):
    rows = []
    for name, design, mass, radius in PUBLISHED:
        found = json.loads(kinefront("evaluate", "--design", design, "--grid", "fine", "--json"))
        claim = json.loads(kinefront("certify", "--design", design, "--json"))
        rows.append(
            [
                name,
                mass,
                f"{found['mass_kg']:.2f}",
                radius,
                f"{found['workspace_radius_m']:.4f}",
                f"{claim['lower_m']:.4f} to {claim['upper_m']:.4f}",
            ]
        )
    header = ["design", "mass, paper (kg)", "mass (kg)", "R_w, paper (m)", "R_w, fine grid (m)", "R_w, proved (m)"]
    return table(header, rows)


def proofs(kinefront):
    columns = ["3-PRR", "3-RPR", "3-RRR"]
    rows = [
        ["designs reported, all of them proved"],
        ["designs examined whose radius on the fine grid is too large"],
        ["of these by more than 0.1 %"],
        ["largest loss of R_w, at least"],
        ["thicker bars, by at most 0.1 %, restore the radius"],
    ]
    for architecture in columns:
        with tempfile.TemporaryDirectory() as folder:
            run = pathlib.Path(folder) / "run"
            kinefront(
                "optimize", "paper", "--seed", "7", "--architectures", architecture, "--no-recording", "--quiet", "--out", str(run)
            )
            found = json.loads((run / "run.json").read_text())["proofs"]
        assert found["open"] == 0, found
        losses = [1 - each["infeasible_at_m"] / each["fine_radius_m"] for each in found["refuted"]]
        thickened = [each["thickened"]["increase"] for each in found["refuted"] if each["thickened"]]
        assert all(increase <= 1e-3 for increase in thickened), thickened
        rows[0].append(str(found["proved"]))
        rows[1].append(str(len(losses)))
        rows[2].append(str(sum(loss > 1e-3 for loss in losses)))
        rows[3].append(f"{100 * max(losses):.1f} %" if losses else "–")
        rows[4].append(str(len(thickened)))
    return table(["`kinefront optimize paper --seed 7 --architectures …`", *columns], rows)


def studies(kinefront):
    rows = []
    for line in kinefront("study", "list").splitlines():
        name, description = line.split(maxsplit=1)
        rows.append(f"| `{name}` | {description.replace(chr(124), chr(92) + chr(124))} |")
    return "\n".join(["| study | question |", "|---|---|", *rows])


TABLES = {"published": published, "proofs": proofs, "studies": studies}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="kinefront")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME", default=[])
    arguments = parser.parse_args()

    def kinefront(*command):
        return subprocess.run([arguments.program, *command], check=True, stdout=subprocess.PIPE, text=True).stdout

    stale, found = [], set()
    for path in sorted(FOLDER.glob("*.md")):
        text = path.read_text(encoding="utf-8")

        def renew(match):
            name = match.group(1)
            if arguments.names and name not in arguments.names:
                return match.group(0)
            if name not in TABLES:
                sys.exit(f"{path.name}: there is no table {name}; there are {', '.join(TABLES)}")
            found.add(name)
            return f"<!-- make.py {name} -->\n\n{TABLES[name](kinefront)}\n\n<!-- end -->"

        renewed = re.sub(r"<!-- make\.py (\w+) -->.*?<!-- end -->", renew, text, flags=re.S)
        if renewed != text and arguments.check:
            stale.append(f"{path.name}: a table is not current; run docs/make.py")
        elif renewed != text:
            path.write_text(renewed, encoding="utf-8")
    missing = set(arguments.names or TABLES) - found
    if missing:
        stale.append(f"no document has the tables {', '.join(sorted(missing))}")
    if stale:
        sys.exit("\n".join(stale))


main()
