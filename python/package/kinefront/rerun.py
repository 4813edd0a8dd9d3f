"""Designs in a recording of the Rerun SDK."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import rerun as rr

if TYPE_CHECKING:
    from ._kinefront import Design


def log_design(entity: str, design: Design, *, recording: rr.RecordingStream | None = None) -> None:
    """Log the solids of a design, with its regular workspace, as an asset at an entity of a recording."""
    contents = design.export("gltf")
    rr.log(entity, rr.Asset3D(contents=contents, media_type="model/gltf-binary"), recording=recording)


def log_recording(path: str | os.PathLike[str], *, recording: rr.RecordingStream | None = None) -> None:
    """Add a whole Kinefront recording, such as ``recording.rrd`` of a run folder, to another recording."""
    rr.log_file_from_path(path, recording=recording)
