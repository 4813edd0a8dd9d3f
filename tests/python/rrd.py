"""What several checks of recordings share: the Rerun package's own verifier and reader."""

import subprocess
from pathlib import Path

import pyarrow as pa
import rerun
from rerun.experimental import RrdReader


def open_verified(path):
    """Return a reader of a recording that `rerun rrd verify` accepts."""
    command = Path(rerun.__file__).parent.parent / "rerun_cli" / "rerun"
    verified = subprocess.run([str(command), "rrd", "verify", str(path)], capture_output=True, text=True)
    assert verified.returncode == 0 and "1 file verified without error" in verified.stderr, verified.stderr
    return RrdReader(str(path))


def tables_of(chunks):
    """Return the rows of each entity of some chunks as one table; a column that a row does not have is null there."""
    entities = {}
    for chunk in chunks:
        batch = chunk.to_record_batch()
        part = pa.Table.from_batches([batch.replace_schema_metadata(None)])
        entities.setdefault(str(chunk.entity_path), []).append(part)
    return {entity: pa.concat_tables(parts, promote_options="default") for entity, parts in entities.items()}
