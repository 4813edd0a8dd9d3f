"""Searches six architectures of the study `all-planar-architectures` alone, with several random seeds each, and writes the table of the
lightest designs into README.md: make.py PROGRAM [--seeds N] [--evaluations N] [--keep FOLDER].
"""

import argparse
import csv
import pathlib
import re
import subprocess
import tempfile

PAGE = pathlib.Path(__file__).resolve().parent / "README.md"
STUDY = "all-planar-architectures"
# Those that are the lightest at some radius, with rails and without, and the paper's 3-RRR.
ARCHITECTURES = ["3-P_PR", "3-PRR", "3-RPR", "3-RR_P", "3-R_RR", "3-RRR"]
# Radii of the table [m].
LEVELS = [0.3, 0.5, 0.9, 1.3, 1.7, 2.1]


def lightest(run):
    """The least mass of the front with at least each radius; None where no design is so large."""
    with open(run / "front.csv", encoding="utf-8") as file:
        rows = [(float(row["workspace_radius_m"]), float(row["mass_kg"])) for row in csv.DictReader(file)]
    return [min((mass for radius, mass in rows if radius >= level), default=None) for level in LEVELS]


def cell(of_seeds):
    """The least mass of all seeds, and by how much the worst seed is heavier."""
    found = [mass for mass in of_seeds if mass is not None]
    if not found:
        return "–"
    spread = 100 * (max(found) / min(found) - 1)
    fewer = "" if len(found) == len(of_seeds) else f", {len(found)} of {len(of_seeds)} seeds"
    return f"{min(found):.4g} (+{spread:.1f} %{fewer})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--evaluations", type=int, default=6000)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the runs; those that it has are not repeated")
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.program).resolve())
    with tempfile.TemporaryDirectory() as folder:
        work = arguments.keep or pathlib.Path(folder)
        columns = []
        for architecture in ARCHITECTURES:
            found = []
            for seed in range(1, arguments.seeds + 1):
                run = work / f"{architecture}-seed-{seed}"
                if not (run / "front.csv").exists():
                    search = [program, "optimize", STUDY, "--architectures", architecture, "--seed", str(seed), "--no-recording", "--quiet"]
                    subprocess.run([*search, "--evaluations", str(arguments.evaluations), "--out", str(run)], check=True)
                found.append(lightest(run))
            columns.append([cell(of_seeds) for of_seeds in zip(*found)])
    lines = ["| R_w [m] | " + " | ".join(ARCHITECTURES) + " |", "|---|" + "---|" * len(ARCHITECTURES)]
    lines += [f"| {level} | " + " | ".join(cells) + " |" for level, cells in zip(LEVELS, zip(*columns))]
    table = "\n".join(lines)
    text = PAGE.read_text(encoding="utf-8")
    marked = re.compile(r"(<!-- make\.py table -->\n\n).*?(\n\n<!-- end -->)", re.S)
    if not marked.search(text):
        raise SystemExit("README.md has no place for the table")
    PAGE.write_text(marked.sub(lambda mark: f"{mark.group(1)}{table}{mark.group(2)}", text), encoding="utf-8")


main()
