"""Designs and sweeps on a cluster, with Dask.

If a worker is lost, another worker repeats its task. The results are those of this machine to the last bit, because
an evaluation depends on neither the processor nor the number of threads.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import sweeps
from ._kinefront import Study, Table

if TYPE_CHECKING:
    from distributed import Client

_RETRIES = 3


def _evaluate(text: str, name: str, designs: dict[str, Any], grid: str, threads: int | None) -> Table:
    return Study.from_toml(text, name).evaluate(designs, grid=grid, threads=threads)


def evaluate(
    study: Study,
    designs: Mapping[str, Any],
    client: Client,
    *,
    grid: str = "reference",
    chunk: int = 2000,
    threads: int | None = 1,
) -> Table:
    """Evaluate designs, columns of length n as for ``Study.evaluate``, in tasks of ``chunk`` designs.

    ``threads`` is the number of threads of a task: 1 suits workers with one thread for each core, and ``None`` workers with a whole
    machine. Returns the table that ``study.evaluate(designs)`` returns.
    """
    columns = {name: value if isinstance(value, str) or np.ndim(value) == 0 else np.asarray(value) for name, value in designs.items()}
    lengths = {len(value) for value in columns.values() if isinstance(value, np.ndarray)}
    if len(lengths) > 1:
        raise ValueError(f"the columns differ in length: {sorted(lengths)}")
    count = lengths.pop() if lengths else 1

    def part(first: int) -> dict[str, Any]:
        of = {name: value[first : first + chunk] if isinstance(value, np.ndarray) else value for name, value in columns.items()}
        return {name: value.tolist() if isinstance(value, np.ndarray) and value.dtype.kind in "OUT" else value for name, value in of.items()}

    text = study.to_toml()
    futures = [
        client.submit(_evaluate, text, study.name, part(first), grid, threads, retries=_RETRIES, pure=False)
        for first in range(0, count, chunk)
    ]
    return Table.concat(client.gather(futures))


def sweep(
    study: Study,
    readings: Mapping[str, str | Study],
    seeds: Iterable[int | None],
    client: Client,
    *,
    evaluations: int | None = None,
    threads: int | None = 1,
) -> list[sweeps.Search]:
    """Search a study once for each set of assumptions (reading) and seed, each in a separate task.

    The arguments and the result are those of ``kinefront.sweeps.sweep``.
    """
    options = {"evaluations": evaluations, "threads": threads}
    futures = [
        client.submit(sweeps.search, *task, options, retries=_RETRIES, pure=False)
        for task in sweeps.tasks(study, readings, seeds)
    ]
    return client.gather(futures)
