"""A study as a problem of pymoo."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from pymoo.core.problem import Problem

if TYPE_CHECKING:
    from ._kinefront import Study

_WORST = 1e30
"""Value of an objective that an infeasible design does not have."""


class StudyProblem(Problem):
    """The designs of one architecture of a study.

    The variables are those of ``study.bounds``, in their order and units. One that the study lists or takes from a catalogue of bars has
    the nearest of its values, and one that is tied follows the other. Objectives are minimized, so the values of an objective that
    the study maximizes are negated. The one inequality constraint is the violation of the study's constraints, which is 0 for a
    feasible design.
    """

    def __init__(self, study: Study, architecture: str | None = None, *, threads: int | None = None) -> None:
        self.study = study
        self.architecture = architecture or study.architectures[0]
        self.threads = threads
        self.names = list(study.bounds)
        low, high = np.array([study.bounds[name] for name in self.names]).T
        self._signs = np.array([1.0 if goal == "minimize" else -1.0 for goal, _ in study.objectives])
        super().__init__(n_var=len(self.names), n_obj=len(self._signs), n_ieq_constr=1, xl=low, xu=high)

    def designs(self, x: np.ndarray) -> dict[str, Any]:
        """Return the columns of the designs whose variables are the rows of ``x``, of shape (n, n_var)."""
        columns: dict[str, Any] = {name: x[:, k] for k, name in enumerate(self.names)}
        for name, listed in self.study.choices.items():
            values = np.array(listed)
            columns[name] = values[np.abs(values[:, None] - columns[name]).argmin(axis=0)]
        for name, (source, factor) in self.study.ties.items():
            columns[name] = factor * columns[source]
        columns["architecture"] = self.architecture
        return columns

    def _evaluate(self, x: np.ndarray, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
        table = self.study.evaluate(self.designs(np.asarray(x, dtype=float)), threads=self.threads)
        values = np.column_stack([table[name] for name in self.study.objective_columns])
        out["F"] = np.where(np.isnan(values), _WORST, values * self._signs)
        out["G"] = table["violation"][:, None]
