"""Searches each architecture of the study `all-planar-architectures` alone, with several random seeds each: as the study states, with joints
and motors that have a mass, and on rails that bend and weigh. Writes the tables of the lightest designs into README.md:

    make.py PROGRAM [--evaluations N] [--keep FOLDER]
"""

import argparse
import csv
import json
import pathlib
import re
import subprocess
import tempfile

PAGE = pathlib.Path(__file__).resolve().parent / "README.md"
STUDY = "all-planar-architectures"
# Those with a prismatic joint on the base lead.
ON_RAILS = ["3-PRR", "3-P_RR", "3-PR_R", "3-P_PR", "3-_PPR", "3-PR_P", "3-_PRP"]
WITHOUT_RAILS = ["3-RPR", "3-_RPR", "3-RP_R", "3-RRR", "3-R_RR", "3-RR_R", "3-RR_P", "3-R_RP", "3-_RRP", "3-RP_P", "3-R_PP"]
# Radii of the tables [m].
LEVELS = [0.3, 0.5, 0.9, 1.3, 1.7, 2.1]
# Designs of a front that are tried until the workspace of one is proved.
TRIED = 5
# Options of each search.
OPTIONS = ["--front", "60", "--no-recording", "--quiet"]
# Only the designs of the tables are proved: the proofs of all take longer than the searches.
UNPROVED = "[workspace]\ncertify = false\n"
# What a copy of the study states in addition, and the number of random seeds.
QUESTIONS = {
    "as the study states": ("", 3),
    "joints and motors with mass": ("[joints]\nrevolute_kg = 0.4\ncarriage_kg = 0.8\nmotor_kg = 1.5\n", 2),
    "rails of 30 mm diameter on 9 supports": ("[rails]\nradius_m = 0.015\nspans = 8\n", 2),
    "rails of 60 mm diameter on 5 supports": ("[rails]\nradius_m = 0.03\nspans = 4\n", 2),
}


def lightest(program, run):
    """The least mass of a verified design whose workspace is proved at each radius; None where there is none."""
    with open(run / "front.csv", encoding="utf-8") as file:
        rows = [(float(row["mass_kg"]), float(row["workspace_radius_m"]), row["id"]) for row in csv.DictReader(file)]
    found = []
    for level in LEVELS:
        large = sorted(row for row in rows if row[1] >= level)
        found.append(next((mass for mass, _, id in large[:TRIED] if is_proved(program, run, id, level)), None))
    return found


def is_proved(program, run, id, radius):
    command = [program, "certify", f"{run / 'front.csv'}#{id}", "--radius", str(radius), "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["verdict"] == "proved"


def asked(question, architecture):
    """The question of which an architecture gives the answer: without rails, one about rails changes nothing."""
    is_same = question.startswith("rails") and architecture in WITHOUT_RAILS
    return next(iter(QUESTIONS)) if is_same else question


def search(arguments, work, question, architecture, seed):
    """The folder of a run."""
    text, _ = QUESTIONS[question]
    study = work / f"{question.replace(' ', '-')}.toml"
    if not study.exists():
        whole = subprocess.run([arguments.program, "study", "show", STUDY], check=True, capture_output=True, text=True).stdout
        study.write_text(f"{whole}\n{text}{UNPROVED}", encoding="utf-8")
    run = work / f"{study.stem}-{architecture}-{seed}"
    if not (run / "front.csv").exists():
        command = [arguments.program, "optimize", study, "--architectures", architecture, "--seed", seed, "--evaluations", arguments.evaluations]
        subprocess.run([*map(str, command), *OPTIONS, "--out", str(run)], check=True)
    return run


def cell(masses):
    """The least mass of all seeds, and by how much the worst seed is heavier."""
    found = [mass for mass in masses if mass is not None]
    if not found:
        return "–"
    spread = 100 * (max(found) / min(found) - 1)
    fewer = "" if len(found) == len(masses) else f", {len(found)} of {len(masses)} seeds"
    return f"{min(found):.4g} (+{spread:.1f} %{fewer})"


def table(head, rows):
    return "\n".join(f"| {' | '.join(row)} |" for row in [head, ["---"] * len(head), *rows])


def of_architectures(found):
    """One row for each architecture."""
    rows = [[architecture, *map(cell, zip(*of_seeds))] for architecture, of_seeds in found.items()]
    return table(["architecture", *(f"{level} m" for level in LEVELS)], rows)


def of_leaders(found):
    """The lightest architecture of each question."""
    rows = []
    for place, level in enumerate(LEVELS):
        row = [f"{level} m"]
        for of_question in found.values():
            masses = [(of_levels[place], name) for name, of_seeds in of_question.items() for of_levels in of_seeds if of_levels[place]]
            row.append("{:.4g} ({})".format(*min(masses)))
        rows.append(row)
    return table(["R_w", *found], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--evaluations", type=int, default=3000)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the runs; those that it has are not repeated")
    arguments = parser.parse_args()
    arguments.program = str(pathlib.Path(arguments.program).resolve())
    with tempfile.TemporaryDirectory() as folder:
        work = arguments.keep or pathlib.Path(folder)
        work.mkdir(parents=True, exist_ok=True)
        runs = {}
        for seed in range(1, 1 + max(seeds for _, seeds in QUESTIONS.values())):
            for question, (_, seeds) in QUESTIONS.items():
                for architecture in ON_RAILS + WITHOUT_RAILS if seed <= seeds else []:
                    key = asked(question, architecture), architecture, seed
                    runs[key] = runs.get(key) or search(arguments, work, *key)
        masses = {key: lightest(arguments.program, run) for key, run in runs.items()}

    def found(question):
        of_seeds = {}
        for architecture in ON_RAILS + WITHOUT_RAILS:
            own = (asked(question, architecture), architecture)
            of_seeds[architecture] = [of_levels for key, of_levels in masses.items() if key[:2] == own]
        return of_seeds

    plain, joints = list(QUESTIONS)[:2]
    tables = {
        "alone": of_architectures(found(plain)),
        "joints": of_architectures(found(joints)),
        "leaders": of_leaders({question: found(question) for question in QUESTIONS}),
    }
    text = PAGE.read_text(encoding="utf-8")
    for name, lines in tables.items():
        marked = re.compile(rf"(<!-- make\.py {name} -->\n\n).*?(\n*<!-- end -->)", re.S)
        if not marked.search(text):
            raise SystemExit(f"README.md has no place for the table {name}")
        text = marked.sub(lambda mark: f"{mark.group(1)}{lines}\n\n<!-- end -->", text)
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
