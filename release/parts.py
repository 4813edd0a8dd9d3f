"""Writes the licences and the list of the crates that are in a program: parts.py --licences FILE --sbom FILE [OPTIONS OF CARGO].

The list is a bill of materials in CycloneDX 1.5. `cargo about` and `cargo cyclonedx` do the same, but each of them takes longer to build
than the server program; what they would read, `cargo metadata` prints.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys

LICENCE = re.compile(r"^(licen[cs]e|copying|unlicense|notice|copyright)", re.IGNORECASE)


def metadata(options):
    """What cargo knows of the packages for the system that is built for."""
    target = os.environ.get("CARGO_BUILD_TARGET")
    if not target:
        told = subprocess.run(["rustc", "-vV"], capture_output=True, text=True, check=True).stdout
        target = re.search(r"^host: (.*)$", told, re.M).group(1)
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", target, *options]
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)


def linked(found):
    """The packages that are linked into the program, and the ids of those that each depends on."""
    nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
    packages = {package["id"]: package for package in found["packages"]}
    macros = {
        id for id, package in packages.items() if any("proc-macro" in target["kind"] for target in package["targets"])
    }
    root = found["resolve"]["root"]
    reached, waiting = {}, [root]
    while waiting:
        id = waiting.pop()
        if id in reached:
            continue
        normal = [
            dependency["pkg"]
            for dependency in nodes[id]["deps"]
            if any(kind["kind"] is None for kind in dependency["dep_kinds"]) and dependency["pkg"] not in macros
        ]
        reached[id] = normal
        waiting.extend(normal)
    return root, packages, reached


def texts(package):
    """The texts of the licences that a package comes with."""
    folder = pathlib.Path(package["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if path.is_file() and LICENCE.match(path.name))
    named = package.get("license_file")
    if named and (folder / named).is_file():
        files.append(folder / named)
    return [path.read_text(encoding="utf-8", errors="replace").strip() for path in files]


def write_licences(path, crates):
    """A list of the crates with their licences, then each text once with the crates that it belongs to."""
    owners = {}
    lines = ["Kinefront contains the crates below, under the licences that stand beside them. The texts follow.", ""]
    for package in crates:
        name = f"{package['name']} {package['version']}"
        lines.append(f"{name}: {package['license'] or 'see the text'}")
        for text in texts(package):
            # Copies differ in their line breaks alone.
            owners.setdefault(" ".join(text.split()), (text, []))[1].append(name)
    for text, names in sorted(owners.values(), key=lambda owner: owner[1]):
        lines += ["", "=" * 100, ", ".join(dict.fromkeys(names)), "=" * 100, "", text]
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def reference(package):
    return f"pkg:cargo/{package['name']}@{package['version']}"


def write_sbom(path, root, packages, reached):
    program = packages[root]
    components = []
    for id in sorted(reached, key=lambda id: (packages[id]["name"], packages[id]["version"])):
        package = packages[id]
        if id == root:
            continue
        component = {
            "type": "library",
            "bom-ref": reference(package),
            "name": package["name"],
            "version": package["version"],
            "purl": reference(package),
        }
        if package["license"]:
            # Before expressions there were lists with a slash.
            component["licenses"] = [{"expression": package["license"].replace("/", " OR ")}]
        if package.get("repository"):
            component["externalReferences"] = [{"type": "vcs", "url": package["repository"]}]
        components.append(component)
    dependencies = [
        {"ref": reference(packages[id]), "dependsOn": sorted({reference(packages[other]) for other in others})}
        for id, others in sorted(reached.items(), key=lambda item: reference(packages[item[0]]))
    ]
    bill = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "bom-ref": reference(program),
                "name": program["name"],
                "version": program["version"],
                "purl": reference(program),
                "licenses": [{"expression": program["license"]}],
            }
        },
        "components": components,
        "dependencies": dependencies,
    }
    pathlib.Path(path).write_text(json.dumps(bill, indent=1) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(allow_abbrev=False)
    parser.add_argument("--licences", required=True)
    parser.add_argument("--sbom", required=True)
    arguments, options = parser.parse_known_args()
    root, packages, reached = linked(metadata(options))
    crates = sorted((packages[id] for id in reached if id != root), key=lambda package: (package["name"], package["version"]))
    write_licences(arguments.licences, [package for package in crates if package["source"]])
    write_sbom(arguments.sbom, root, packages, reached)
    without = [package["name"] for package in crates if package["source"] and not texts(package) and not package["license"]]
    if without:
        sys.exit(f"no licence is known of {', '.join(without)}")


main()
