"""Writes what follows from commands in the documents: make.py [--program PATH] [--check] [NAME ...].

A table stands between `<!-- make.py NAME -->` and `<!-- end -->` in a document of this folder. The commands of each document in SESSIONS
are run in order in an empty folder that has the files of the document, and each marked text block becomes what the shell block before it
has printed:

    <!-- output -->          all of it
    <!-- output: part -->    from the line that begins as the first line of the block does to the one that begins as the last one does
    <!-- output: lines -->   for each line of the block, the line that begins as it does

Without names everything is written. With --check nothing is written, and what is not current is an error.
"""

import argparse
import json
import pathlib
import re
import shlex
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

# Documents whose commands are run, each with the headings of the sections that are, or all of them, and the document whose files it uses.
SESSIONS = {
    "tutorial": (None, None),
    "howto": (["From a payload to requirements", "Drives"], "tutorial"),
}

BLOCK = re.compile(r"(?:<!-- (?P<mark>output[^>]*?|file: [^>]*?) -->\n\n)?^```(?P<kind>\w*)\n(?P<body>.*?)^```$", re.M | re.S)


def key(line):
    """What a line is known by: the corner of a frame, the first cell, or the text up to a colon without its numbers."""
    if line[:1] in "┌├╞└":
        return line[:1]
    cells = re.split("[│┆]", line)
    return cells[1].strip() if len(cells) > 2 else re.sub(r"\d+", "#", line.split(":")[0]).strip()


def renewed_block(mark, body, printed):
    """A text block with what commands have printed."""
    old, new = body.splitlines(), printed.splitlines()
    find = lambda line, start=0: next(at for at in range(start, len(new)) if key(new[at]) == key(line))
    try:
        if mark == "output: lines":
            new = [new[find(line)] for line in old]
        elif mark == "output: part":
            first = find(old[0])
            new = new[first : find(old[-1], first) + 1]
    except StopIteration:
        sys.exit(f"a line of this block is not printed any more:\n{body}\nPrinted:\n{printed}")
    return "\n".join(line.rstrip() for line in new) + "\n"


def files(text):
    return {match["mark"].removeprefix("file: "): match["body"] for match in BLOCK.finditer(text) if (match["mark"] or "").startswith("file")}


def session(text, headings, others, kinefront):
    """The text of a document with what its commands print."""
    missing = set(headings or []) - set(re.findall(r"^##+ (.*)$", text, re.M))
    marked = sum((match["mark"] or "").startswith("output") for match in BLOCK.finditer(text))
    if missing or marked == 0 or marked != text.count("<!-- output"):
        sys.exit(f"a heading is missing ({missing or 'none'}), or a mark stands without its block ({marked} of {text.count('<!-- output')} have one)")
    with tempfile.TemporaryDirectory() as folder:
        for name, contents in [*files(others).items(), *files(text).items()]:
            (pathlib.Path(folder) / name).write_text(contents, encoding="utf-8")
        printed = ""

        def renew(match):
            nonlocal printed
            above = re.findall(r"^##+ (.*)$", text[: match.start()], re.M)
            if headings is not None and not set(above[-1:]) & set(headings):
                return match.group(0)
            if match["kind"] == "sh":
                printed = ""
                for line in match["body"].replace("\\\n", " ").splitlines():
                    words = shlex.split(re.split(r"\s#", line)[0])
                    if words[:1] == ["kinefront"] and words[1] != "explore":
                        printed += kinefront(*words[1:], cwd=folder)
            mark = match["mark"] or ""
            if not mark.startswith("output"):
                return match.group(0)
            return f"<!-- {mark} -->\n\n```{match['kind']}\n{renewed_block(mark, match['body'], printed)}```"

        return BLOCK.sub(renew, text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="kinefront")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[[], *TABLES, *SESSIONS], default=[])
    arguments = parser.parse_args()
    is_asked = lambda name: not arguments.names or name in arguments.names

    def kinefront(*command, cwd=None):
        done = subprocess.run([arguments.program, *command], cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"kinefront {shlex.join(command)}\n{done.stdout}{done.stderr}")
        return done.stdout

    stale, found = [], set()
    for path in sorted(FOLDER.glob("*.md")):
        text = path.read_text(encoding="utf-8")

        def renew(match):
            name = match.group(1)
            if name not in TABLES:
                sys.exit(f"{path.name}: there is no table {name}; there are {', '.join(TABLES)}")
            if not is_asked(name):
                return match.group(0)
            found.add(name)
            return f"<!-- make.py {name} -->\n\n{TABLES[name](kinefront)}\n\n<!-- end -->"

        renewed = re.sub(r"<!-- make\.py (\w+) -->.*?<!-- end -->", renew, text, flags=re.S)
        if path.stem in SESSIONS and is_asked(path.stem):
            headings, other = SESSIONS[path.stem]
            others = (FOLDER / f"{other}.md").read_text(encoding="utf-8") if other else ""
            renewed = session(renewed, headings, others, kinefront)
            found.add(path.stem)
        if renewed != text and arguments.check:
            old, new = text.splitlines(), renewed.splitlines()
            place = next((at for at, lines in enumerate(zip(old, new)) if lines[0] != lines[1]), min(len(old), len(new)))
            stale.append(f"{path.name}, line {place + 1} is not current; run docs/make.py. It is now:\n{(new + [''])[place]}")
        elif renewed != text:
            path.write_text(renewed, encoding="utf-8")
    missing = set(arguments.names or [*TABLES, *SESSIONS]) - found
    if missing:
        stale.append(f"no document has {', '.join(sorted(missing))}")
    if stale:
        sys.exit("\n".join(stale))


main()
