"""A study as an objective of Optuna."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from optuna.trial import FrozenTrial, Trial

    from ._kinefront import Study

_WORST = 1e30
_VIOLATION = "violation"


class Objective:
    """The objectives of a study, for ``optuna.create_study(directions=objective.directions)``.

    The architecture is a categorical variable if the study has several, and so is a variable that the study lists or takes from a
    catalogue of bars. The violation of the study's constraints is a constraint of
    each trial, which samplers take into account; with Optuna 4, pass them ``constraints_func=objective.constraints``.
    """

    def __init__(self, study: Study) -> None:
        self.study = study
        self.directions = [goal for goal, _ in study.objectives]

    def design(self, trial: Trial | FrozenTrial) -> dict[str, float | str]:
        """Return the columns of the design that a trial suggests, or suggested: ``study.designs(objective.design(trial))``."""
        choices, ties = self.study.choices, self.study.ties
        values: dict[str, float | str] = {}
        for name, (low, high) in self.study.bounds.items():
            if name in choices:
                values[name] = trial.suggest_categorical(name, choices[name])
            elif name not in ties:
                values[name] = trial.suggest_float(name, low, high)
        for name, (source, factor) in ties.items():
            values[name] = factor * float(values[source])
        names = self.study.architectures
        values["architecture"] = trial.suggest_categorical("architecture", names) if len(names) > 1 else names[0]
        return values

    def __call__(self, trial: Trial) -> tuple[float, ...]:
        """Evaluate the design that a trial suggests; return its objectives."""
        table = self.study.evaluate(self.design(trial), threads=1)
        violation = float(table[_VIOLATION][0])
        trial.set_user_attr(_VIOLATION, violation)
        if hasattr(trial, "set_constraint"):
            trial.set_constraint(_VIOLATION, violation)
        objectives = [float(table[name][0]) for name in self.study.objective_columns]
        worst = [_WORST if goal == "minimize" else -_WORST for goal in self.directions]
        return tuple(bad if np.isnan(value) else value for value, bad in zip(objectives, worst))

    @staticmethod
    def constraints(trial: FrozenTrial) -> Sequence[float]:
        """Return the violation of the study's constraints, which is 0 for a feasible design."""
        return [trial.user_attrs[_VIOLATION]]
