"""Sweeps: searches of a study under alternative assumptions (readings) and seeds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from ._kinefront import Study, Table


@dataclass(frozen=True)
class Search:
    """One search of a sweep."""

    reading: str
    """Name of the set of assumptions."""
    seed: int
    """Random seed."""
    front: Table
    """The verified front."""
    report: dict[str, Any]
    """What ``run.json`` states."""

    @property
    def hypervolume(self) -> float:
        """Hypervolume of the verified front, in the units of the objectives."""
        return float(self.report["verified_hypervolume_kg_m"])


def search(study: Study, reading: str, seed: int | None, options: dict[str, Any]) -> Search:
    """Perform one search of a sweep: ``study`` under the assumptions named ``reading``."""
    run = study.optimize(seed=seed, **options)
    assert run.report is not None
    return Search(reading, study.optimizer["seed"] if seed is None else seed, run.front, run.report)


def sweep(
    study: Study,
    readings: Mapping[str, str | Study],
    seeds: Iterable[int | None],
    *,
    evaluations: int | None = None,
    threads: int | None = None,
    callback: Callable[[Search], None] | None = None,
) -> list[Search]:
    """Search a study once for each set of assumptions (reading) and seed, one search after the other.

    ``readings`` gives, for the name of each reading, its study or the settings that it replaces, as the text of a part of a study
    file; an empty text is the study as it is. The seed ``None`` is that of the study. The result is ordered by reading and seed, and
    each search is that of ``study.replace(settings).optimize(seed=seed)``. The sensitivity of the report of the program is

        sweep(study, study.sensitivity(evaluations), [None])
    """
    options = {"evaluations": evaluations, "threads": threads}
    found = []
    for task in tasks(study, readings, seeds):
        found.append(search(*task, options))
        if callback is not None:
            callback(found[-1])
    return found


def tasks(
    study: Study, readings: Mapping[str, str | Study], seeds: Iterable[int | None]
) -> list[tuple[Study, str, int | None]]:
    """Return the arguments of the searches of a sweep, in their order."""
    seeds = list(seeds)
    studies = {name: study.replace(reading) if isinstance(reading, str) else reading for name, reading in readings.items()}
    return [(of_reading, name, seed) for name, of_reading in studies.items() for seed in seeds]
