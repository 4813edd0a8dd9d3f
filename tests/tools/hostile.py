"""Makes run folders as somebody might hand them over: hostile.py RUN OUT COUNT SEED.

Each folder is a copy of the run with one or several of its files spoiled: missing, empty, cut, with changed bytes, values of other
types, numbers that are out of range, links to a file outside and to devices, pipes, folders, and files of a terabyte without contents.
"""

import json
import os
import random
import shutil
import sys

FILES = ["study.toml", "designs.csv", "front.csv", "run.json", "progress.json"]


def spoil_bytes(path, rng, change):
    # What an earlier change has made of the file is not opened: a pipe would wait, and a link would lead outside.
    if os.path.islink(path) or (os.path.exists(path) and not os.path.isfile(path)):
        return
    data = bytearray(open(path, "rb").read()) if os.path.isfile(path) else bytearray(b"{}")
    open(path, "wb").write(change(data, rng))


def flipped(data, rng):
    for _ in range(rng.randint(1, 20)):
        if data:
            data[rng.randrange(len(data))] = rng.randrange(256)
    return data


def values(node):
    """Every place of a JSON document, as its container and key."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in list(items):
        yield node, key
        yield from values(value)


def other_json(data, rng):
    try:
        document = json.loads(bytes(data))
    except ValueError:
        return data
    places = list(values(document))
    for _ in range(rng.randint(1, 3)):
        if places:
            node, key = rng.choice(places)
            node[key] = rng.choice([None, -1, 1e308, 2**63, "\x1b]0;t\x07", [], {}, "x" * 5000, True, "9.9.9"])
    return json.dumps(document).encode()


def other_fields(data, rng):
    lines = data.split(b"\n")
    for _ in range(rng.randint(1, 4)):
        row = rng.randrange(len(lines))
        fields = lines[row].split(b",")
        fields[rng.randrange(len(fields))] = rng.choice(
            [b"", b"NaN", b"-1", b"1e999", b"999999999999", b'"', b"=1+1", b"\x1b[2J", b"\x00", b"x" * 70000]
        )
        lines[row] = b",".join(fields)
    return b"\n".join(lines)


def replace(path, make):
    if os.path.islink(path) or os.path.exists(path):
        os.remove(path)
    make(path)


def spoil(folder, rng, victim):
    path = os.path.join(folder, rng.choice(FILES))
    kinds = [
        lambda: os.path.exists(path) and os.remove(path),
        lambda: replace(path, lambda p: open(p, "wb").close()),
        lambda: spoil_bytes(path, rng, lambda data, rng: data[: rng.randrange(len(data) + 1)]),
        lambda: spoil_bytes(path, rng, flipped),
        lambda: spoil_bytes(path, rng, other_json if path.endswith("json") else other_fields),
        lambda: spoil_bytes(path, rng, other_json if path.endswith("json") else other_fields),
        lambda: spoil_bytes(path, rng, lambda data, rng: data + data[rng.randrange(len(data) + 1) :]),
        lambda: replace(path, lambda p: os.symlink(victim, p)),
        lambda: replace(path, lambda p: os.symlink("/dev/zero", p)),
        lambda: replace(path, os.mkfifo),
        lambda: replace(path, os.mkdir),
        lambda: replace(path, lambda p: os.truncate(os.open(p, os.O_CREAT | os.O_WRONLY), 1 << 40)),
        lambda: os.symlink(victim, os.path.join(folder, f".{os.path.basename(path)}.partial")),
        lambda: replace(os.path.join(folder, "recording.rrd"), lambda p: os.symlink(victim, p)),
    ]
    rng.choice(kinds)()


def main():
    run, out, count, seed = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    rng = random.Random(seed)
    victim = os.path.join(out, "victim")
    os.makedirs(out)
    open(victim, "w").write("precious")
    for number in range(count):
        folder = os.path.join(out, f"run{number}")
        shutil.copytree(run, folder)
        for _ in range(rng.choice([1, 1, 1, 2, 3])):
            try:
                spoil(folder, rng, victim)
            except (FileExistsError, IsADirectoryError, ValueError, OSError):
                pass


main()
