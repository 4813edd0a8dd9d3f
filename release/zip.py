"""Packs a folder under its own name into a zip archive that is the same on every machine: zip.py FOLDER ARCHIVE TIME, with the time of
its files in seconds since 1970.
"""

import pathlib
import sys
import time
import zipfile

folder, archive, seconds = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as packed:
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        entry = zipfile.ZipInfo(path.relative_to(folder.parent).as_posix(), time.gmtime(seconds)[:6])
        entry.compress_type = zipfile.ZIP_DEFLATED
        # What is a program on the systems that have such a permission.
        entry.external_attr = (0o755 if path.suffix == ".exe" else 0o644) << 16
        packed.writestr(entry, path.read_bytes())
